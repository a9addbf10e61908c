//! Curves as text: a table of all points, and lines for other programs.

use super::{CurvePoint, Intersection};

/// The points of some intersections as comma-separated values, with a header line.
///
/// A row for each point: the names of both sides; the branch, counted from 0, and whether it is closed, both empty for
/// points in which surfaces only touch; position, surfaces and parameters, residual, tangent, angle in degrees, mark
/// and failure.
pub fn csv(intersections: &[([String; 2], &Intersection)]) -> String {
    let mut text = String::from(
        "first,second,branch,closed,x,y,z,surface 1,u1,v1,surface 2,u2,v2,residual,tangent x,tangent y,tangent z,angle,mark,failure\n",
    );
    for ([one, two], intersection) in intersections {
        for (index, branch) in intersection.branches.iter().enumerate() {
            for point in &branch.points {
                text.push_str(&format!("{},{},{index},{},{}", quoted(one), quoted(two), branch.is_closed, row(point)));
            }
        }
        for point in &intersection.touching {
            text.push_str(&format!("{},{},,,{}", quoted(one), quoted(two), row(point)));
        }
    }
    text
}

fn quoted(name: &str) -> String {
    format!("\"{}\"", name.replace('"', "\"\""))
}

fn row(point: &CurvePoint) -> String {
    let [one, two] = point.coordinates.map(|place| {
        let surface = place.surface.map_or(String::new(), |surface| surface.to_string());
        format!("{surface},{:?},{:?}", place.uv.x, place.uv.y)
    });
    let (p, t) = (point.position, point.tangent);
    let failure = point.inaccuracy.map_or(String::new(), |failure| failure.to_string());
    format!(
        "{:?},{:?},{:?},{one},{two},{:?},{:?},{:?},{:?},{:?},{},{failure}\n",
        p.x,
        p.y,
        p.z,
        point.residual,
        t.x,
        t.y,
        t.z,
        point.angle,
        point.mark.word()
    )
}

/// The branches of some intersections as lines of an OBJ file, one object for each intersection.
pub fn obj(intersections: &[([String; 2], &Intersection)]) -> String {
    let mut text = String::new();
    let mut count = 0;
    for ([one, two], intersection) in intersections {
        text.push_str(&format!("o {} and {}\n", one.replace('\n', " "), two.replace('\n', " ")));
        for branch in &intersection.branches {
            let mut indices = String::from("l");
            let first = count + 1;
            for point in &branch.points {
                let p = point.position;
                count += 1;
                text.push_str(&format!("v {:?} {:?} {:?}\n", p.x, p.y, p.z));
                indices.push_str(&format!(" {count}"));
            }
            if branch.is_closed {
                indices.push_str(&format!(" {first}"));
            }
            if branch.points.len() > 1 {
                text.push_str(&indices);
                text.push('\n');
            }
        }
    }
    text
}
