//! Numbers and points with their first and second derivatives by two parameters.

use std::ops::{Add, Mul, Sub};

use glam::DVec3;

/// A value that depends on u and v, with its derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Jet<T> {
    /// The value.
    pub value: T,
    /// The derivatives by u and v.
    pub first: [T; 2],
    /// The derivatives by uu, uv and vv.
    pub second: [T; 3],
}

impl<T: Copy> Jet<T> {
    fn with<U, V>(self, other: Jet<U>, f: impl Fn(T, U) -> V) -> Jet<V>
    where
        U: Copy,
    {
        Jet {
            value: f(self.value, other.value),
            first: [0, 1].map(|k| f(self.first[k], other.first[k])),
            second: [0, 1, 2].map(|k| f(self.second[k], other.second[k])),
        }
    }
}

impl Jet<f64> {
    /// A number that depends on nothing.
    pub fn constant(value: f64) -> Self {
        Jet { value, first: [0.0; 2], second: [0.0; 3] }
    }

    /// One of the two parameters.
    pub fn parameter(value: f64, which: usize) -> Self {
        Jet { first: [0, 1].map(|k| f64::from(u8::from(k == which))), ..Self::constant(value) }
    }

    /// A function of this number, by its value and its first two derivatives there.
    pub fn into<T>(self, [value, by, by_by]: [T; 3]) -> Jet<T>
    where
        T: Copy + Add<Output = T> + Mul<f64, Output = T>,
    {
        let [u, v] = self.first;
        let [uu, uv, vv] = self.second;
        let second = |product: f64, own: f64| by_by * product + by * own;
        Jet { value, first: [by * u, by * v], second: [second(u * u, uu), second(u * v, uv), second(v * v, vv)] }
    }

    /// One over it.
    pub fn recip(self) -> Self {
        let inverse = self.value.recip();
        self.into([inverse, -inverse * inverse, 2.0 * inverse * inverse * inverse])
    }
}

impl<T: Copy + Add<Output = T>> Add for Jet<T> {
    type Output = Jet<T>;

    fn add(self, other: Self) -> Self {
        self.with(other, |a, b| a + b)
    }
}

impl<T: Copy + Sub<Output = T>> Sub for Jet<T> {
    type Output = Jet<T>;

    fn sub(self, other: Self) -> Self {
        self.with(other, |a, b| a - b)
    }
}

impl<T: Copy + Add<Output = T> + Mul<f64, Output = T>> Mul<Jet<f64>> for Jet<T> {
    type Output = Jet<T>;

    fn mul(self, other: Jet<f64>) -> Self {
        let ([au, av], [bu, bv]) = (self.first, other.first);
        let (a, b) = (self.value, other.value);
        let [auu, auv, avv] = self.second;
        let [buu, buv, bvv] = other.second;
        Jet {
            value: a * b,
            first: [au * b + a * bu, av * b + a * bv],
            second: [
                auu * b + au * (2.0 * bu) + a * buu,
                auv * b + au * bv + av * bu + a * buv,
                avv * b + av * (2.0 * bv) + a * bvv,
            ],
        }
    }
}

/// A polynomial of degree at most 5 with points for coefficients, the constant one first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polynomial([DVec3; 6]);

impl Polynomial {
    /// The cubic with some Bezier points.
    pub fn cubic([a, b, c, d]: [DVec3; 4]) -> Polynomial {
        let zero = DVec3::ZERO;
        Polynomial([a, (b - a) * 3.0, ((c - b) - (b - a)) * 3.0, (d - a) - (c - b) * 3.0, zero, zero])
    }

    /// The line with some values at 0 and 1.
    pub fn line(from: DVec3, to: DVec3) -> Polynomial {
        let zero = DVec3::ZERO;
        Polynomial([from, to - from, zero, zero, zero, zero])
    }

    /// Its derivative.
    pub fn derivative(&self) -> Polynomial {
        Polynomial(std::array::from_fn(|k| self.0.get(k + 1).map_or(DVec3::ZERO, |c| *c * (k + 1) as f64)))
    }

    /// This polynomial from 1 to 0.
    pub fn reversed(&self) -> Polynomial {
        let choose = |n: usize, k: usize| (0..k).fold(1.0, |c, i| c * (n - i) as f64 / (i + 1) as f64);
        let term = |k: usize| (k..6).map(|n| self.0[n] * choose(n, k)).sum::<DVec3>();
        Polynomial(std::array::from_fn(|k| if k % 2 == 0 { term(k) } else { -term(k) }))
    }

    /// The product with a linear function that has some values at 0 and 1; the degree is at most 4.
    pub fn times(&self, [from, to]: [f64; 2]) -> Polynomial {
        let before = |k: usize| k.checked_sub(1).map_or(DVec3::ZERO, |k| self.0[k]);
        Polynomial(std::array::from_fn(|k| self.0[k] * from + before(k) * (to - from)))
    }

    /// The sum with another one.
    pub fn plus(&self, other: &Polynomial) -> Polynomial {
        Polynomial(std::array::from_fn(|k| self.0[k] + other.0[k]))
    }

    /// Its value at a number.
    pub fn at(&self, t: f64) -> DVec3 {
        self.0.iter().rev().fold(DVec3::ZERO, |sum, c| sum * t + *c)
    }

    /// Its value at a number that depends on parameters.
    pub fn of(&self, t: Jet<f64>) -> Jet<DVec3> {
        let (first, second) = (self.derivative(), self.derivative().derivative());
        t.into([self.at(t.value), first.at(t.value), second.at(t.value)])
    }
}
