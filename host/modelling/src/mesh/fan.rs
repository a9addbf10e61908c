//! Polygons and strips of files as triangles.

/// Divides a polygon into a fan of triangles around its first corner.
pub(super) fn fan<T: Copy>(corners: &[T]) -> impl Iterator<Item = [T; 3]> + '_ {
    corners.windows(2).skip(1).map(|pair| [corners[0], pair[0], pair[1]])
}

/// The triangles of a strip, oriented alike; those with two equal corners, which only join strips, are left out.
pub(super) fn strip(corners: &[u32]) -> impl Iterator<Item = [u32; 3]> + '_ {
    let triangle = |(k, t): (usize, &[u32])| [t[0], t[1 + k % 2], t[2 - k % 2]];
    corners.windows(3).enumerate().map(triangle).filter(|[a, b, c]| a != b && b != c && c != a)
}
