//! A damped spring as a network, driven by a clock: where it is stable, and how far it is from the closed form.
//!
//! x'' = -k x - c x', as two accumulators of the changes of a step of h seconds, one step a frame:
//!
//! - *semi-implicit* (symplectic) Euler: V accumulates -h (k x + c v), and what leaves V goes through a factor h into
//!   X, so that X moves with the *new* velocity. The spring is stable for k h^2 + 2 c h < 4.
//! - *explicit* Euler: a SYNC holds the old velocity for X as well. The spring is stable for h k < c and
//!   4 - 2 c h + k h^2 > 0.
//!
//! (Jury's conditions on the step's matrix: determinant 1 - c h or 1 - c h + k h^2, trace 2 - c h - k h^2 or 2 - c h.)
//! Outside the values grow until a real overflows: a fault of one function, and the loop stands still.
//!
//! Error at 1 s of a spring with k = 100 / s^2, c = 2 / s, released at x = 1 (closed form -0.337):
//!
//! | h, s | semi-implicit | explicit |
//! |---|---|---|
//! | 0.01 | 0.0220 | 0.199 |
//! | 0.005 | 0.0105 | 0.0859 |
//! | 0.0025 | 0.00513 | 0.0401 |
//! | 0.00125 | 0.00253 | 0.0194 |
//!
//! Half the step, half the error: both are of first order. Stiff by six orders of magnitude (decay rates of 1 and
//! 10^6 / s, k = 10^6, c = 10^6 + 1): stable below h = 2.0 us only, whatever is asked of the slow part.

use crate::network::tests::Bench;
use crate::port::{
    Cause, Effect, Fault,
    Literal::{B, I, R},
};
use protocol::Value;

#[derive(Clone, Copy, PartialEq, Debug)]
enum Method {
    SemiImplicit,
    Explicit,
}
use Method::{Explicit, SemiImplicit};

/// A spring at x = 1, at rest, with a clock that asks for a step each frame.
fn spring(method: Method, k: f64, c: f64, h: f64) -> Bench {
    let mut bench = Bench::default();
    bench
        .define("CLOCK:=F:CLFRAMES GATE:=F:SYNC(3) PULL:=F:MULC DRAG:=F:MULC FORCE:=F:ADD MOVE:=F:MULC")
        .define("V:=F:ACCUMULATE X:=F:ACCUMULATE")
        .connect("CLOCK<1>:<1>GATE X<1>:<2>GATE V<1>:<3>GATE X<1>:<1>OUT")
        .connect("GATE<2>:<1>PULL GATE<3>:<1>DRAG PULL<1>:<1>FORCE DRAG<1>:<2>FORCE FORCE<1>:<1>V MOVE<1>:<1>X")
        .connect(if method == SemiImplicit { "V<1>:<1>MOVE" } else { "GATE<3>:<1>MOVE" })
        .send(R(-k * h), 2, "PULL")
        .send(R(-c * h), 2, "DRAG")
        .send(R(h), 2, "MOVE")
        .send(R(0.0), 2, "V")
        .send(R(1.0), 2, "X")
        .send(R(1.0), 2, "GATE")
        .send(R(0.0), 3, "GATE")
        .send(I(1), 1, "CLOCK")
        .send(B(true), 3, "CLOCK")
        .send(B(true), 4, "CLOCK");
    bench
}

/// The positions after each step, and the faults.
fn steps(bench: &mut Bench, steps: u64) -> (Vec<f64>, Vec<Fault>) {
    let (mut places, mut faults) = (Vec::new(), Vec::new());
    for frame in 1..=steps {
        bench.network.advance(frame, 0, &mut bench.effects);
        assert!(bench.network.run(100, &mut bench.effects).idle);
        for effect in bench.effects.drain(..) {
            match effect {
                Effect::Deliver { value: Value::Real(x), .. } => places.push(x),
                Effect::Fault { fault, .. } => faults.push(fault),
                other => panic!("{other:?}"),
            }
        }
    }
    (places, faults)
}

/// The position at time t of a spring at x = 1, at rest at first.
fn closed_form(k: f64, c: f64, t: f64) -> f64 {
    let (decay, square) = (c / 2.0, k - c * c / 4.0);
    if square > 0.0 {
        let w = square.sqrt();
        (-decay * t).exp() * ((w * t).cos() + decay / w * (w * t).sin())
    } else {
        // The slow rate from the product of both, since their difference would lose it.
        let fast = decay + (-square).sqrt();
        let slow = k / fast;
        (fast * (-slow * t).exp() - slow * (-fast * t).exp()) / (fast - slow)
    }
}

#[test]
fn each_step_is_the_step_of_its_method() {
    for method in [SemiImplicit, Explicit] {
        let (k, c, h) = (100.0, 2.0, 0.01);
        let (places, faults) = steps(&mut spring(method, k, c, h), 50);
        assert_eq!((places.len(), faults.len()), (50, 0));
        let (mut x, mut v) = (1.0, 0.0);
        for place in places {
            let old = v;
            v += -k * h * x + -c * h * v;
            x += h * if method == SemiImplicit { v } else { old };
            assert!((place - x).abs() < 1e-12, "{method:?}");
        }
    }
}

#[test]
fn the_error_is_of_first_order_in_the_step() {
    let (k, c) = (100.0, 2.0);
    let expected = [(SemiImplicit, [0.0220, 0.0105, 0.00513, 0.00253]), (Explicit, [0.199, 0.0859, 0.0401, 0.0194])];
    for (method, errors) in expected {
        for (halvings, expected) in (0..).zip(errors) {
            let count = 100 << halvings;
            let (places, _) = steps(&mut spring(method, k, c, 1.0 / count as f64), count);
            let error = (places.last().unwrap() - closed_form(k, c, 1.0)).abs();
            assert!((error - expected).abs() < 0.005 * expected, "{method:?} {count} steps: {error}");
        }
    }
}

#[test]
fn the_semi_implicit_spring_is_stable_up_to_its_limit_over_six_orders_of_stiffness() {
    for exponent in 0..=6 {
        let (slow, fast) = (1.0, 10_f64.powi(exponent));
        let (k, c) = (slow * fast, slow + fast);
        // k h^2 + 2 c h = 4
        let limit = 4.0 / (c + (c * c + 4.0 * k).sqrt());
        let (inside, faults) = steps(&mut spring(SemiImplicit, k, c, 0.98 * limit), 3_000);
        assert_eq!(faults, []);
        assert!(inside.iter().all(|x| x.abs() <= 1.0) && inside[2_999] < inside[0], "1 to {fast}");
        let (outside, faults) = steps(&mut spring(SemiImplicit, k, c, 1.5 * limit), 3_000);
        assert_eq!(faults.iter().map(|fault| fault.cause).collect::<Vec<_>>(), [Cause::Overflow], "1 to {fast}");
        assert!(outside.last().unwrap().abs() > 1e290 && outside.len() < 2_000);
    }
}

#[test]
fn the_explicit_spring_is_stable_up_to_its_limit_and_never_without_drag() {
    for k in [1.0, 1e2, 1e4, 1e6_f64] {
        // Drag at a tenth of the critical: the limit is h = c / k.
        let c = 0.2 * k.sqrt();
        let (inside, faults) = steps(&mut spring(Explicit, k, c, 0.9 * c / k), 2_000);
        assert!(faults.is_empty() && inside[1_999].abs() < 0.05, "{k}: {}", inside[1_999]);
        let (outside, _) = steps(&mut spring(Explicit, k, c, 1.1 * c / k), 2_000);
        assert!(outside.iter().rev().take(100).any(|x| x.abs() > 50.0), "{k}");
        let h = 0.1 / k.sqrt();
        let (semi_implicit, _) = steps(&mut spring(SemiImplicit, k, 0.0, h), 2_000);
        assert!(semi_implicit.iter().all(|x| x.abs() < 1.01), "without drag it swings for ever");
        let (explicit, _) = steps(&mut spring(Explicit, k, 0.0, h), 2_000);
        assert!(explicit.iter().any(|x| x.abs() > 1e3), "without drag it grows for every step");
    }
}

#[test]
fn a_stiff_spring_follows_the_closed_form_below_its_limit() {
    let (k, c, h) = (1e6, 1e6 + 1.0, 1e-6);
    let (places, faults) = steps(&mut spring(SemiImplicit, k, c, h), 20_000);
    assert_eq!(faults, []);
    for (step, x) in (1..).zip(&places).step_by(1_000) {
        let t = f64::from(step) * h;
        assert!((x - closed_form(k, c, t)).abs() < 1.1e-6, "{t}: {x} {}", closed_form(k, c, t));
    }
}
