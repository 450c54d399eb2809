use super::*;
use proptest::prelude::*;

fn turns(numerator: i64, denominator: i64) -> Angle {
    Angle::from_turns(numerator, denominator).unwrap()
}

fn typed(text: &str) -> Angle {
    text.parse().unwrap()
}

fn float(degrees: f64) -> Angle {
    Angle::from_degrees(degrees).unwrap()
}

#[test]
fn small_fractions_of_a_turn_are_recognised() {
    assert_eq!(float(360.0 / 7.0), turns(1, 7));
    assert_eq!(float(-120.0), turns(-1, 3));
    assert_eq!(typed("360/7"), turns(1, 7));
    assert_eq!(float(0.0), Angle::ZERO);
    assert_eq!(float(-0.0), Angle::ZERO);
    assert_eq!(float(1e-300), Angle(Degrees(1e-300)));
}

#[test]
fn typed_decimals_floats_and_fractions_are_one_angle() {
    for same in ["49.54", " 49.540", "+4954e-2", "4.954e1", "2477/50", "-2477/-50"] {
        assert_eq!(typed(same), float(49.54), "{same}");
    }
    assert_eq!(float(49.54), turns(2477, 18_000));
    assert_eq!(typed("-236.3700117504").reduced(), typed("123.6299882496"));
    for six in ["123.456789", "-0.000001", "1e-6", "359.999999", "999999.999999"] {
        assert_eq!(typed(six), float(six.parse().unwrap()), "{six}");
        assert!(typed(six).turns().is_some());
    }
    assert_eq!(typed("49.1234567"), typed("491234567/10000000"));
    assert_eq!(float(49.123_456_7), typed("49.1234567"));
    // The digits of a double, not those of a decimal.
    assert_eq!(typed("51.42857142857143"), turns(1, 7));
    assert_eq!(typed("70.2439024390244"), turns(8, 41));
    assert_eq!(typed("-359.9999999999999").reduced(), typed("0.0000000000001"));
    assert_eq!(float(70.243_902_439_024_4), turns(8, 41));
    assert_eq!(typed("720051.4285714285"), float(720_000.0 + 360.0 / 7.0));
    assert_eq!(typed("0.30000000000000004"), turns(1, 1200));
}

#[test]
fn a_float_stands_for_a_decimal_within_four_units_in_the_last_place() {
    assert_ne!(0.1 + 0.2, 0.3);
    assert_eq!(float(0.1 + 0.2), typed("0.3"));
    assert_eq!(float(3.0 * 17.123_456), typed("51.370368"));
    let beyond = (0..5).fold(0.3_f64, |x, _| x.next_up());
    assert_eq!(float(beyond), Angle(Degrees(beyond)));
    assert_eq!(float(0.123_456_7).turns(), Some((1_234_567, 3_600_000_000)));
    // A double of twelve digits was typed, thirteen are those of a double; text is typed.
    assert!(float(49.541_234_567_8).turns().is_some());
    assert_eq!(typed("49.5412345678"), float(49.541_234_567_8));
    assert_eq!(float(49.541_234_567_89), Angle(Degrees(49.541_234_567_89)));
    assert_eq!(typed("49.54123456789"), typed("4954123456789/100000000000"));
    assert_eq!(typed("4.954123456789e1"), float(49.541_234_567_89));
}

#[test]
fn a_float_is_a_fraction_within_four_units_in_the_last_place() {
    for (parts, part) in [(7, 360.0 / 7.0), (-7, -360.0 / 7.0), (997, 360.0 / 997.0)] {
        let exact = turns(i64::from(parts).signum(), i64::from(parts).abs());
        let moved = |step: fn(f64) -> f64, times: u32| (0..times).fold(part, |x, _| step(x));
        for step in [f64::next_up, f64::next_down] {
            assert_eq!(float(moved(step, 4)), exact);
            let beyond = moved(step, 5);
            assert_eq!(float(beyond), Angle(Degrees(beyond)));
        }
    }
    // Given as a fraction it is one, of more parts too.
    assert_eq!(typed("1/7"), turns(1, 2520));
    assert_eq!(Angle::from_degree_fraction(1, -7), Ok(turns(-1, 2520)));
}

/// The banks of every vee of whole hundredths, typed and computed.
#[test]
fn bores_of_a_vee_are_those_typed() {
    for k in 1..18_000_i64 {
        let half = float(k as f64 / 100.0).half();
        let decimal = |thousandths: i64| -> f64 {
            format!("{}.{:03}", thousandths / 1000, thousandths % 1000).parse().unwrap()
        };
        assert_eq!(Angle::QUARTER_TURN + half, float(decimal(90_000 + 5 * k)), "{k}");
        // Below 90° from zero, so that the sign of -0.005 is written.
        let below = if 5 * k > 90_000 { -1.0 } else { 1.0 };
        let right = float(below * decimal((90_000 - 5 * k).abs()));
        assert_eq!(Angle::QUARTER_TURN - half, right, "{k}");
        let split = (Angle::QUARTER_TURN + half) - right;
        assert_eq!(split, float(k as f64 / 100.0), "{k}");
    }
}

#[test]
fn angles_of_six_decimals_are_added_and_halved_exactly() {
    let (a, b) = (typed("61.234567"), typed("118.765433"));
    assert_eq!(a + b, Angle::HALF_TURN);
    let quarter = |angle: Angle| angle.half().half();
    assert_eq!(quarter(a).turns(), Some((61_234_567, 1_440_000_000)));
    assert_eq!(quarter(a) + quarter(b), turns(1, 8));
    assert_eq!(quarter(a) - quarter(b) + quarter(b), quarter(a));
    let seventh = turns(1, 7);
    assert_eq!(quarter(a) + seventh - quarter(a), seventh);
}

#[test]
fn a_near_miss_is_named() {
    let (simple, distance) = typed("51.428571").near_miss().unwrap();
    assert_eq!(simple, turns(1, 7));
    assert!((distance - 3e-6 / 7.0).abs() < 1e-20, "{distance:e}");
    let (simple, distance) = float(-120.000_001_234_5).near_miss().unwrap();
    assert_eq!(simple, turns(-1, 3));
    assert!((distance - 1.234_5e-6).abs() < 1e-13, "{distance:e}");
    let (simple, _) = (turns(2, 1) + typed("0.00001")).near_miss().unwrap();
    assert_eq!(simple, turns(2, 1));
    for far in [turns(1, 7), turns(999, 1000), typed("49.54"), typed("120.00002")] {
        assert_eq!(far.near_miss(), None, "{far}");
    }
}

#[test]
fn quarter_turns_have_exact_phasors() {
    let quarter = Angle::from_degrees(90.0).unwrap();
    assert_eq!(quarter.cis(1), Complex64::new(0.0, 1.0));
    assert_eq!(quarter.cis(-1), Complex64::new(0.0, -1.0));
    assert_eq!(quarter.cis(10_002), Complex64::new(-1.0, 0.0));
}

#[test]
fn no_angle_that_is_none() {
    for bad in [f64::NAN, f64::INFINITY, 1e300] {
        assert!(Angle::from_degrees(bad).is_err());
    }
    for bad in ["", "x", "1/0", "1/x", "nan", "1e400", "99999999999999999999/7"] {
        assert!(bad.parse::<Angle>().is_err(), "{bad}");
    }
    let error = Angle::from_degree_fraction(1, 0).unwrap_err().to_string();
    assert!(error.contains("1/0: the denominator"), "{error}");
}

#[test]
fn angles_have_a_largest() {
    let largest = LARGEST_ANGLE as i64;
    assert_eq!(Angle::from_degrees(LARGEST_ANGLE).unwrap().degrees(), LARGEST_ANGLE);
    assert!(Angle::from_degrees(LARGEST_ANGLE.next_up()).is_err());
    assert_eq!(Angle::from_degree_fraction(largest, 1).unwrap().degrees(), LARGEST_ANGLE);
    assert!(Angle::from_degree_fraction(largest + 1, 1).is_err());
    assert!(Angle::from_degree_fraction(-largest - 1, 1).is_err());
}

#[test]
fn fractions_of_large_denominator_are_degrees() {
    let denominator = 7_000_000_000_000_000_001;
    let angle = Angle::from_degree_fraction(1_000_000_000_000_000_001, denominator).unwrap();
    assert_eq!(angle, Angle(Degrees(1_000_000_000_000_000_001.0 / denominator as f64)));
    let small = turns(1, LARGEST_DENOMINATOR - 1);
    let half = 180.0 / (LARGEST_DENOMINATOR - 1) as f64;
    assert_eq!(small.half(), Angle(Degrees(half)));
    assert_eq!(turns(2, 7).half(), turns(1, 7));
    assert_eq!(turns(1, 7).half(), turns(1, 14));
    assert_eq!(Angle::from_degree_fraction(90, -1), Ok(turns(-1, 4)));
    assert_eq!(Angle::from_degree_fraction(-90, -2), Ok(turns(1, 8)));
    assert_eq!(Angle::from_degree_fraction(0, -5), Ok(Angle::ZERO));
}

/// n·angle reduced to a turn exactly, in integers: a double of degrees is whole over 2^40 here.
#[test]
fn high_orders_of_any_angle_keep_their_phase() {
    let scale = 1_i128 << 40;
    for k in 1..50_i64 {
        let degrees = 123.0 + (7919 * k) as f64 / scale as f64 * 1e6;
        let degrees = (degrees * scale as f64).round() / scale as f64;
        let whole = (degrees * scale as f64) as i128;
        for n in [1, 3, 9_999, -10_000, 123_456_789] {
            let rest = (whole * n).rem_euclid(360 * scale) as f64 / scale as f64;
            let exact = Complex64::cis(rest.to_radians());
            // Both argument and unit are rounded: 2π·1.1e-16, and some units of the sine.
            assert!((Angle(Degrees(degrees)).cis(n as i64) - exact).norm() < 3e-15);
        }
    }
    // Where the product overflows 64 bits as where it does not.
    let large = Angle(Turns(i64::MAX / 5, 7));
    let small = turns((i64::MAX / 5) % 7, 7);
    assert_eq!(large.cis(10_000), small.cis(10_000));
    assert_eq!(large.cis(-10_001), small.cis(-10_001));
}

#[test]
fn angles_are_in_order_only_with_their_like_or_where_they_differ() {
    let part = Angle::QUARTER_TURN;
    let odd = |degrees| Angle(Degrees(degrees));
    assert_eq!(odd(49.541_234_567_89).partial_cmp(&odd(49.541_234_567_89)), Some(Ordering::Equal));
    assert_eq!(part.partial_cmp(&odd(89.9)), Some(Ordering::Greater));
    // Too near a double to be distinguished from it, and yet a fraction.
    let (double, fraction) = (float(49.541_234_567_89), typed("4954123456789/100000000000"));
    assert_eq!(double.degrees(), fraction.degrees());
    assert_eq!(double.partial_cmp(&fraction), None);
}

proptest! {
    #[test]
    fn text_reads_back(numerator in -10_000_i64..10_000, denominator in 1_i64..5_000) {
        let angle = Angle::from_degree_fraction(numerator, denominator).unwrap();
        prop_assert_eq!(angle.to_string().parse::<Angle>(), Ok(angle));
    }

    #[test]
    fn floats_read_back(degrees in -720.0..720.0) {
        let angle = Angle::from_degrees(degrees).unwrap();
        prop_assert_eq!(angle.to_string().parse::<Angle>(), Ok(angle));
        prop_assert_eq!(Angle::from_degrees(angle.degrees()), Ok(angle));
        // recognition moves a float by 4 units in the last place at most
        prop_assert!((angle.degrees() - degrees).abs() <= 4.0 * ulp(degrees));
    }

    #[test]
    fn decimals_read_back(digits in -9_999_999_999_i64..9_999_999_999, places in 0_u32..12) {
        let exact = Angle::of_fraction(digits.into(), 10_i128.pow(places)).unwrap();
        prop_assert_eq!(exact.to_string().parse::<Angle>(), Ok(exact));
        let shortest = (digits as f64 / 10_f64.powi(places as i32)).to_string();
        prop_assert_eq!(shortest.parse::<Angle>(), Ok(exact));
        let double = float(shortest.parse().unwrap());
        prop_assert_eq!(double.to_string().parse::<Angle>(), Ok(double));
        prop_assert_eq!(double.degrees(), shortest.parse::<f64>().unwrap());
        prop_assert_eq!(double, exact);
    }

    /// A whole turn away, or there and back by another angle: the same angle, to the last place.
    #[test]
    fn typed_decimals_are_exact(a in -72_000_000_i64..72_000_000, b in 0_i64..1_000_000_000,
                                c in 0_i64..18_000_000, places in 6_usize..=14) {
        let text = |whole: i64, rest: i64| {
            let decimals = format!("{:05}{rest:09}", whole.abs() % 100_000);
            let sign = if whole < 0 { "-" } else { "" };
            format!("{sign}{}.{}", whole.abs() / 100_000, &decimals[..places])
        };
        let whole: i128 = text(a, b).replace('.', "").parse().unwrap();
        let scale = 10_i128.pow(places as u32);
        let angle = typed(&text(a, b));
        prop_assert_eq!(angle, Angle::of_fraction(whole, scale).unwrap());
        prop_assert_eq!(angle.to_string().parse::<Angle>(), Ok(angle));
        let turned = whole - 360 * scale;
        let sign = if turned < 0 { "-" } else { "" };
        let (above, below) = (turned.abs() / scale, turned.abs() % scale);
        let turned = typed(&format!("{sign}{above}.{below:0places$}"));
        prop_assert_eq!(turned.reduced(), angle.reduced());
        let other = typed(&text(c, b)).half();
        prop_assert_eq!(angle + other - other, angle);
        prop_assert_eq!((angle - other) + (other + other), angle + other);
    }

    #[test]
    fn phasors_multiply(a in -400.0..400.0, b in -400.0..400.0, n in -50_i64..50) {
        let (a, b) = (Angle::from_degrees(a).unwrap(), Angle::from_degrees(b).unwrap());
        let difference = (a + b).cis(n) - a.cis(n) * b.cis(n);
        // the sum is rounded by half a unit of 1024° (1.1e-13°), and what it stands for is 4 units away
        // at most; turned n ≤ 50 times: 4.5e-13 rad
        prop_assert!(difference.norm() < 4.6e-13);
    }

    #[test]
    fn fractions_are_compared_as_they_are(a in -720_i64..720, b in -720_i64..720, n in 1_i64..9) {
        let part = |k: i64| Angle::from_degree_fraction(k, n).unwrap();
        prop_assert_eq!(part(a).partial_cmp(&part(b)), a.partial_cmp(&b));
        let floats = (a as f64 + 0.123_456, b as f64 + 0.123_456);
        let degrees = |x| Angle::from_degrees(x).unwrap();
        prop_assert_eq!(degrees(floats.0).partial_cmp(&degrees(floats.1)), a.partial_cmp(&b));
    }

    #[test]
    fn reduction_stays_in_a_cycle(degrees in -1e6..1e6, turns in 1_i64..4) {
        let angle = Angle::from_degrees(degrees).unwrap();
        let rest = angle.reduced_to(turns);
        prop_assert!((0.0..360.0 * turns as f64).contains(&rest.degrees()));
        // what the rest stands for is four and a half units of 1080° (2.3e-13°) away at most, and
        // what is reduced to 360° (5.7e-14°) as many of those, twice: 1.54e-12°
        let apart = (rest.reduced() - angle.reduced()).degrees().abs();
        prop_assert!(apart.min(360.0 - apart) < 1.6e-12);
    }

    #[test]
    fn reduction_stays_in_one_turn(degrees in -1e6..1e6) {
        let angle = Angle::from_degrees(degrees).unwrap().reduced().degrees();
        prop_assert!((0.0..360.0).contains(&angle));
    }

    #[test]
    fn adding_zero_changes_nothing(degrees in -1e6..1e6) {
        // What is reduced may be as near a fraction as a typed double that stands for it.
        let angle = Angle::from_degrees(degrees).unwrap().reduced();
        let sums = [angle + Angle::ZERO, Angle::ZERO + angle, angle - Angle::ZERO];
        prop_assert!(sums.iter().all(|sum| sum.0 == angle.0));
    }
}
