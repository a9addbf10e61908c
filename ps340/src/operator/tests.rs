//! Tests of the operator's orders.

use super::*;

#[test]
fn every_row_has_its_own_word() {
    for (i, row) in ORDERS.iter().enumerate() {
        assert!(ORDERS[..i].iter().all(|r| r.word != row.word), "{}", row.word);
    }
}

#[test]
fn orders_read_back() {
    assert_eq!(parse("dial 3 -0.25"), Ok(Order::Dial { dial: 3, turns: -0.25 }));
    assert_eq!(parse("key 2 shift"), Ok(Order::Key(14)));
    assert_eq!(parse("puck move 0.5 -1"), Ok(Order::PuckMove([0.5, -1.0])));
    assert_eq!(parse("type a b\\r"), Ok(Order::Type("a b\r".into())));
    let file = "my picture.png".to_string();
    assert_eq!(
        parse("picture vector my picture.png 512"),
        Ok(Order::Picture { screen: Screen::Vector, file, size: Some(512) })
    );
}

#[test]
fn bad_orders_name_the_word_that_is_wrong() {
    assert_eq!(parse(""), Err(OrderError::Missing("an order")));
    assert_eq!(parse("dance"), Err(OrderError::Unknown("dance".into())));
    assert_eq!(parse("dial 9 1"), Err(OrderError::Bad { found: "9".into(), expected: "a dial, 1 to 8" }));
    assert_eq!(parse("dial 1 NaN"), Err(OrderError::Bad { found: "NaN".into(), expected: "a number of turns" }));
    assert_eq!(parse("button 3 4"), Err(OrderError::TooMuch("4".into())));
}

#[test]
fn a_reply_is_one_line() {
    assert_eq!(reply(&Ok(String::new())), "ok");
    assert_eq!(reply(&Ok("a\nb\\".into())), "ok a\\nb\\\\");
    assert_eq!(reply(&Err("no".into())), "error no");
}
