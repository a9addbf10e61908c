//! The algebra of values: sums, products, limits and distances by the typing rules of the machine.

use protocol::Value;

/// The sum of two values, by the typing rules; none if they do not add.
#[inline]
pub fn sum(a: &Value, b: &Value) -> Option<Value> {
    Some(match (a, b) {
        (Value::Integer(a), Value::Integer(b)) => Value::Integer(a.wrapping_add(*b)),
        (Value::Vector2(a), Value::Vector2(b)) => Value::Vector2(*a + *b),
        (Value::Vector3(a), Value::Vector3(b)) => Value::Vector3(*a + *b),
        (Value::Vector4(a), Value::Vector4(b)) => Value::Vector4(*a + *b),
        (Value::Matrix2(a), Value::Matrix2(b)) => Value::Matrix2(Box::new(**a + **b)),
        (Value::Matrix3(a), Value::Matrix3(b)) => Value::Matrix3(Box::new(**a + **b)),
        (Value::Matrix4(a), Value::Matrix4(b)) => Value::Matrix4(Box::new(**a + **b)),
        _ => Value::Real(a.number()? + b.number()?),
    })
}

/// The difference of two values, by the typing rules; none if they do not subtract.
#[inline]
pub fn difference(a: &Value, b: &Value) -> Option<Value> {
    Some(match (a, b) {
        (Value::Integer(a), Value::Integer(b)) => Value::Integer(a.wrapping_sub(*b)),
        (Value::Vector2(a), Value::Vector2(b)) => Value::Vector2(*a - *b),
        (Value::Vector3(a), Value::Vector3(b)) => Value::Vector3(*a - *b),
        (Value::Vector4(a), Value::Vector4(b)) => Value::Vector4(*a - *b),
        (Value::Matrix2(a), Value::Matrix2(b)) => Value::Matrix2(Box::new(**a - **b)),
        (Value::Matrix3(a), Value::Matrix3(b)) => Value::Matrix3(Box::new(**a - **b)),
        (Value::Matrix4(a), Value::Matrix4(b)) => Value::Matrix4(Box::new(**a - **b)),
        _ => Value::Real(a.number()? - b.number()?),
    })
}

/// The product of two values in row-vector order, by the typing rules; none if they do not multiply.
///
/// The machine's `p M` is glam's `m * p`, and its `A B` is glam's `b * a`.
#[inline]
pub fn product(a: &Value, b: &Value) -> Option<Value> {
    Some(match (a, b) {
        (Value::Integer(a), Value::Integer(b)) => Value::Integer(a.wrapping_mul(*b)),
        (Value::Integer(_) | Value::Real(_), Value::Integer(_) | Value::Real(_)) => {
            Value::Real(a.number()? * b.number()?)
        }
        (Value::Integer(_) | Value::Real(_), any) => scaled(any, a.number()?)?,
        (any, Value::Integer(_) | Value::Real(_)) => scaled(any, b.number()?)?,
        (Value::Vector2(v), Value::Matrix2(m)) => Value::Vector2(**m * *v),
        (Value::Vector3(v), Value::Matrix3(m)) => Value::Vector3(**m * *v),
        (Value::Vector3(v), Value::Matrix4x3(m)) => Value::Vector3(m.transform_point3(*v)),
        (Value::Vector4(v), Value::Matrix4(m)) => Value::Vector4(**m * *v),
        (Value::Matrix2(a), Value::Matrix2(b)) => Value::Matrix2(Box::new(**b * **a)),
        (Value::Matrix3(a), Value::Matrix3(b)) => Value::Matrix3(Box::new(**b * **a)),
        (Value::Matrix4x3(a), Value::Matrix4x3(b)) => Value::Matrix4x3(Box::new(**b * **a)),
        (Value::Matrix4(a) | Value::Matrix4x3(a), Value::Matrix4(b) | Value::Matrix4x3(b)) => {
            Value::Matrix4(Box::new(**b * **a))
        }
        _ => return None,
    })
}

/// A vector or matrix times a number; none for other kinds.
fn scaled(value: &Value, factor: f64) -> Option<Value> {
    Some(match value {
        Value::Vector2(v) => Value::Vector2(*v * factor),
        Value::Vector3(v) => Value::Vector3(*v * factor),
        Value::Vector4(v) => Value::Vector4(*v * factor),
        Value::Matrix2(m) => Value::Matrix2(Box::new(**m * factor)),
        Value::Matrix3(m) => Value::Matrix3(Box::new(**m * factor)),
        Value::Matrix4(m) => Value::Matrix4(Box::new(**m * factor)),
        _ => return None,
    })
}

/// A number, vector or matrix divided by a number that is not 0; none for other kinds.
pub fn quotient(value: &Value, divisor: f64) -> Option<Value> {
    Some(match value {
        Value::Vector2(v) => Value::Vector2(*v / divisor),
        Value::Vector3(v) => Value::Vector3(*v / divisor),
        Value::Vector4(v) => Value::Vector4(*v / divisor),
        Value::Matrix2(m) => Value::Matrix2(Box::new(**m / divisor)),
        Value::Matrix3(m) => Value::Matrix3(Box::new(**m / divisor)),
        Value::Matrix4(m) => Value::Matrix4(Box::new(**m / divisor)),
        _ => Value::Real(value.number()? / divisor),
    })
}

/// A number, or each component of a vector, made no less than `low` and no more than `high`; none for other kinds.
pub fn limited(value: &Value, low: f64, high: f64) -> Option<Value> {
    let limit = |number: f64| number.max(low).min(high);
    Some(match value {
        Value::Integer(i) => {
            let (number, kept) = (f64::from(*i), limit(f64::from(*i)));
            Value::Integer(if kept > number { kept.ceil() } else { kept.floor() } as i32)
        }
        Value::Real(r) => Value::Real(limit(*r)),
        Value::Vector2(v) => Value::Vector2(v.map(limit)),
        Value::Vector3(v) => Value::Vector3(v.map(limit)),
        Value::Vector4(v) => Value::Vector4(v.map(limit)),
        _ => return None,
    })
}

/// How far two values of the same kind are apart: the length of their difference; none if they have none.
pub fn distance(a: &Value, b: &Value) -> Option<f64> {
    Some(match (a, b) {
        (Value::Vector2(a), Value::Vector2(b)) => a.distance(*b),
        (Value::Vector3(a), Value::Vector3(b)) => a.distance(*b),
        (Value::Vector4(a), Value::Vector4(b)) => a.distance(*b),
        _ => (a.number()? - b.number()?).abs(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::port::Literal::{M4, V3, V4};

    #[test]
    fn a_product_transforms_as_its_factors_do_one_after_the_other() {
        let a = M4([[1.0, 2.0, 0.0, 1.0], [0.0, 1.0, 5.0, 0.0], [2.0, 0.0, 1.0, 0.0], [3.0, 4.0, 5.0, 1.0]]).value();
        let b = M4([[0.0, 1.0, 0.0, 0.0], [2.0, 0.0, 0.0, 1.0], [0.0, 0.0, 3.0, 0.0], [1.0, 1.0, 1.0, 1.0]]).value();
        let v = V4([1.0, -2.0, 3.0, 1.0]).value();
        let one_by_one = product(&product(&v, &a).unwrap(), &b).unwrap();
        let at_once = product(&v, &product(&a, &b).unwrap()).unwrap();
        assert_eq!(one_by_one, at_once);
    }

    #[test]
    fn limits_keep_the_kind() {
        assert_eq!(limited(&Value::Integer(7), -2.5, 5.5), Some(Value::Integer(5)));
        assert_eq!(limited(&Value::Integer(-7), -2.5, 5.5), Some(Value::Integer(-2)));
        assert_eq!(limited(&Value::Real(7.0), -2.5, 5.5), Some(Value::Real(5.5)));
        assert_eq!(limited(&V3([9.0, 0.0, -9.0]).value(), -1.0, 1.0), Some(V3([1.0, 0.0, -1.0]).value()));
        assert_eq!(limited(&Value::Boolean(true), 0.0, 1.0), None);
    }
}
