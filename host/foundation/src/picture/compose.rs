//! Two pictures made one: operators on coverage, and the nearer one by depth.

use super::{Deep, Picture, PictureError, Pixel};

/// How two pictures with coverage are combined; each is a weighted sum of both.
///
/// Radiance is premultiplied by coverage, as in mattes. Where both cover part of a pixel, they are taken to be independent
/// of each other: the share that both cover is the product.
///
/// # Source
/// Porter and Duff: Compositing Digital Images, 1984.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Operator {
    /// Nothing
    Clear,
    /// A alone
    Src,
    /// B alone
    Dst,
    /// A in front of B
    Over,
    /// B in front of A
    DstOver,
    /// A where B covers
    In,
    /// B where A covers
    DstIn,
    /// A where B does not cover
    Out,
    /// B where A does not cover
    DstOut,
    /// A in front of B, and only where B covers
    Atop,
    /// B in front of A, and only where A covers
    DstAtop,
    /// Each where the other does not cover
    Xor,
    /// The light of both added; their coverage added up to 1
    Plus,
}

impl Operator {
    /// Every operator.
    pub const ALL: [Operator; 13] = [
        Operator::Clear,
        Operator::Src,
        Operator::Dst,
        Operator::Over,
        Operator::DstOver,
        Operator::In,
        Operator::DstIn,
        Operator::Out,
        Operator::DstOut,
        Operator::Atop,
        Operator::DstAtop,
        Operator::Xor,
        Operator::Plus,
    ];

    /// The weights of A and B, 0..=1, where their coverage is `a` and `b`, 0..=1.
    pub fn weights(self, a: f32, b: f32) -> [f32; 2] {
        match self {
            Operator::Clear => [0.0, 0.0],
            Operator::Src => [1.0, 0.0],
            Operator::Dst => [0.0, 1.0],
            Operator::Over => [1.0, 1.0 - a],
            Operator::DstOver => [1.0 - b, 1.0],
            Operator::In => [b, 0.0],
            Operator::DstIn => [0.0, a],
            Operator::Out => [1.0 - b, 0.0],
            Operator::DstOut => [0.0, 1.0 - a],
            Operator::Atop => [b, 1.0 - a],
            Operator::DstAtop => [1.0 - b, a],
            Operator::Xor => [1.0 - b, 1.0 - a],
            Operator::Plus => [1.0, 1.0],
        }
    }

    /// The operator that gives the same with A and B exchanged.
    pub fn reversed(self) -> Operator {
        match self {
            Operator::Src => Operator::Dst,
            Operator::Dst => Operator::Src,
            Operator::Over => Operator::DstOver,
            Operator::DstOver => Operator::Over,
            Operator::In => Operator::DstIn,
            Operator::DstIn => Operator::In,
            Operator::Out => Operator::DstOut,
            Operator::DstOut => Operator::Out,
            Operator::Atop => Operator::DstAtop,
            Operator::DstAtop => Operator::Atop,
            Operator::Clear | Operator::Xor | Operator::Plus => self,
        }
    }

    /// Whether A and B must be mattes for the result to be right: a background would be taken for a part of them.
    ///
    /// The one in the back of `over` and `atop` may have its background.
    pub fn needs_mattes(self) -> [bool; 2] {
        match self {
            Operator::Clear | Operator::Src | Operator::Dst | Operator::Plus => [false, false],
            Operator::Over | Operator::In | Operator::Out | Operator::Atop => [true, false],
            Operator::DstOver | Operator::DstIn | Operator::DstOut | Operator::DstAtop => [false, true],
            Operator::Xor => [true, true],
        }
    }

    /// One pixel of the result. Coverage is brought into 0..=1.
    pub fn apply(self, a: Pixel, b: Pixel) -> Pixel {
        let (covers, covered) = (share(a.coverage), share(b.coverage));
        let [of_a, of_b] = self.weights(covers, covered);
        let radiance = [0, 1, 2].map(|band| weighted(of_a, a.radiance[band]) + weighted(of_b, b.radiance[band]));
        Pixel { radiance, coverage: share(of_a * covers + of_b * covered) }
    }
}

fn share(coverage: f32) -> f32 {
    coverage.clamp(0.0, 1.0)
}

/// What has no weight adds nothing, even if it is infinite.
fn weighted(weight: f32, value: f32) -> f32 {
    if weight == 0.0 { 0.0 } else { weight * value }
}

/// Combines two pictures pixel by pixel.
///
/// # Errors
/// [`PictureError::Mismatch`] if the sizes differ.
pub fn compose(a: &Picture, operator: Operator, b: &Picture) -> Result<Picture, PictureError> {
    if (a.width, a.height) != (b.width, b.height) {
        return Err(PictureError::Mismatch(a.width, a.height, b.width, b.height));
    }
    let pixels = a.pixels.iter().zip(&b.pixels).map(|(a, b)| operator.apply(*a, *b)).collect();
    Ok(Picture { pixels, ..*a })
}

/// Combines two mattes by depth: at each pixel the nearer one is over the farther one, and A over B at equal depth.
///
/// The depth of the result is the smaller one, so that a third picture can be added.
///
/// # Errors
/// [`PictureError::Mismatch`] if the sizes differ.
///
/// # Source
/// Duff: Compositing 3-D Rendered Images, 1985, with one depth for each pixel instead of four at its corners: where
/// surfaces of A and B cross within a pixel, the one with the smaller mean depth is in front of all of it.
pub fn compose_by_depth(a: &Deep, b: &Deep) -> Result<Deep, PictureError> {
    let mut picture = compose(&a.picture, Operator::Over, &b.picture)?;
    for (i, pixel) in picture.pixels.iter_mut().enumerate() {
        if b.depth[i] < a.depth[i] {
            *pixel = Operator::Over.apply(b.picture.pixels[i], a.picture.pixels[i]);
        }
    }
    let depth = a.depth.iter().zip(&b.depth).map(|(a, b)| a.min(*b)).collect();
    Ok(Deep { picture, depth })
}

#[cfg(test)]
mod tests {
    use super::Operator::*;
    use super::*;

    /// Pixels of all kinds of coverage, radiance premultiplied.
    fn pixels() -> Vec<Pixel> {
        let pixel = |i: u32| {
            let coverage = [0.0, 0.25, 0.5, 0.8, 1.0][i as usize % 5];
            let color = [i, i * i, i * i * i].map(|n| (n % 7) as f32 / 3.0);
            Pixel { radiance: color.map(|c| c * coverage), coverage }
        };
        (1..=20).map(pixel).collect()
    }

    fn sum(a: Pixel, b: Pixel) -> Pixel {
        Pixel { radiance: [0, 1, 2].map(|i| a.radiance[i] + b.radiance[i]), coverage: a.coverage + b.coverage }
    }

    fn is_near(a: Pixel, b: Pixel) -> bool {
        let near = |a: f32, b: f32| (a - b).abs() < 2e-6;
        near(a.coverage, b.coverage) && (0..3).all(|i| near(a.radiance[i], b.radiance[i]))
    }

    fn for_pairs(check: impl Fn(Pixel, Pixel)) {
        pixels().iter().for_each(|a| pixels().iter().for_each(|b| check(*a, *b)));
    }

    #[test]
    fn over_is_associative() {
        for_pairs(|a, b| {
            for c in pixels() {
                assert!(is_near(Over.apply(Over.apply(a, b), c), Over.apply(a, Over.apply(b, c))), "{a:?} {b:?} {c:?}");
                assert!(is_near(In.apply(In.apply(a, b), c), In.apply(a, In.apply(b, c))), "{a:?} {b:?} {c:?}");
            }
        });
    }

    #[test]
    fn in_and_out_divide_a_picture() {
        for_pairs(|a, b| assert!(is_near(sum(In.apply(a, b), Out.apply(a, b)), a), "{a:?} {b:?}"));
    }

    #[test]
    fn over_atop_and_xor_are_sums_of_in_and_out() {
        for_pairs(|a, b| {
            assert!(is_near(Over.apply(a, b), sum(a, Out.apply(b, a))));
            assert!(is_near(Atop.apply(a, b), sum(In.apply(a, b), Out.apply(b, a))));
            assert!(is_near(Xor.apply(a, b), sum(Out.apply(a, b), Out.apply(b, a))));
            assert!(is_near(Over.apply(a, b), sum(Out.apply(a, b), Atop.apply(a, b))));
        });
    }

    #[test]
    fn over_an_opaque_picture_is_atop_it_and_opaque() {
        for_pairs(|a, b| {
            let b = Pixel { coverage: 1.0, ..b };
            let over = Over.apply(a, b);
            assert!(over.coverage == 1.0 && is_near(over, Atop.apply(a, b)));
            assert_eq!(In.apply(a, b), a);
            assert_eq!(Out.apply(a, b), Pixel::default());
            let hides = Pixel { coverage: 1.0, ..a };
            assert_eq!(Over.apply(hides, b), hides);
        });
    }

    #[test]
    fn coverage_is_the_share_of_the_pixel_and_stays_within_0_and_1() {
        for_pairs(|a, b| {
            let (x, y) = (a.coverage, b.coverage);
            let shares = [
                (Over, x + y - x * y),
                (In, x * y),
                (Out, x * (1.0 - y)),
                (Atop, y),
                (Xor, x + y - 2.0 * x * y),
                (Plus, (x + y).min(1.0)),
                (Clear, 0.0),
            ];
            for (operator, expected) in shares {
                assert!((operator.apply(a, b).coverage - expected).abs() < 1e-6, "{operator:?} {x} {y}");
            }
            let wild = Pixel { coverage: 7.0 * x - 3.0, ..a };
            for operator in Operator::ALL {
                assert!((0.0..=1.0).contains(&operator.apply(wild, b).coverage), "{operator:?}");
            }
        });
    }

    #[test]
    fn reversed_operators_exchange_the_pictures() {
        for operator in Operator::ALL {
            for_pairs(|a, b| assert!(is_near(operator.apply(a, b), operator.reversed().apply(b, a)), "{operator:?}"));
            let [a, b] = operator.needs_mattes();
            assert_eq!((operator.reversed().reversed(), operator.reversed().needs_mattes()), (operator, [b, a]));
        }
    }

    #[test]
    fn light_is_added_beyond_white() {
        let [a, b] = [0.75, 0.5].map(|value| Pixel { radiance: [value; 3], coverage: 1.0 });
        assert_eq!(Plus.apply(a, b), Pixel { radiance: [1.25; 3], coverage: 1.0 });
    }

    #[test]
    fn the_nearer_picture_is_over_the_farther_one() {
        let half = |value: f32| Pixel { radiance: [value; 3], coverage: 0.5 };
        let deep = |value: f32, depth: [f32; 4]| {
            let mut picture = Picture::new(4, 1).expect("small");
            picture.pixels_mut().iter_mut().for_each(|pixel| *pixel = half(value));
            Deep::new(picture, depth.to_vec()).expect("a depth for each pixel")
        };
        let far = f32::INFINITY;
        let (a, b) = (deep(0.5, [1.0, 3.0, 2.0, far]), deep(0.25, [2.0, 1.0, 2.0, 9.0]));
        let both = compose_by_depth(&a, &b).expect("same size");
        let (a_first, b_first) = (Over.apply(half(0.5), half(0.25)), Over.apply(half(0.25), half(0.5)));
        assert_eq!(both.picture.pixels(), [a_first, b_first, a_first, b_first]);
        assert_eq!(both.depth, [1.0, 1.0, 2.0, 9.0]);
        assert!(compose(&a.picture, Over, &Picture::new(1, 4).expect("small")).is_err());
    }
}
