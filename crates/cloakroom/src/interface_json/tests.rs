use super::solve_interfaces;
use serde_json::{Value, json};

fn solve(value: &Value) -> Value {
    let solved = solve_interfaces(&value.to_string()).expect("a sound interface");
    serde_json::to_value(solved).expect("JSON")
}

fn refusal(value: &Value) -> String {
    solve_interfaces(&value.to_string()).expect_err("must be refused").to_string()
}

fn glass() -> Value {
    json!({
        "incident": {"permittivity": 1, "permeability": 1},
        "transmitted": {"permittivity": 2.25, "permeability": 1},
        "normal": [2, 0, 0],
        "tangential": [0, 0, 0]
    })
}

fn float(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

#[test]
fn glass_reflects_four_percent() {
    let answer = solve(&glass());
    for column in 0..2 {
        assert!((float(&answer["total_reflected"][column]) - 0.04).abs() < 1e-15);
        assert!((float(&answer["total_transmitted"][column]) - 0.96).abs() < 1e-15);
        assert!((float(&answer["power"][column][column]) - 0.04).abs() < 1e-15);
    }
    assert_eq!(answer["power"].as_array().map(Vec::len), Some(4));
    for (matrix, of_s, of_p) in [("reflected", -0.2, 0.2), ("transmitted", 0.8, 0.8)] {
        let jones = &answer["jones"][matrix];
        assert!((float(&jones[0][0][0]) - of_s).abs() < 1e-15, "{jones}");
        assert!((float(&jones[1][1][0]) - of_p).abs() < 1e-15, "{jones}");
        assert_eq!([&jones[0][1][0], &jones[1][0][1]].map(float), [0.0; 2], "{jones}");
    }
    // Modes carry unit flux: their amplitudes squared are the powers.
    let amplitude = &answer["amplitudes"][2][0];
    let power = float(&amplitude[0]).powi(2) + float(&amplitude[1]).powi(2);
    assert!((power - float(&answer["power"][2][0])).abs() < 1e-15, "{amplitude}");
    let mode = &answer["transmitted"][0];
    assert_eq!(mode["wave_vector"][0], json!([1.5, 0.0]));
    assert_eq!(mode["propagating"], json!(true));
    let flux = float(&mode["poynting"][0]);
    assert!((flux - 1.0).abs() < 1e-15);
}

#[test]
fn an_array_is_answered_by_an_array() {
    let answer = solve(&json!([glass(), glass()]));
    assert_eq!(answer.as_array().map(Vec::len), Some(2));
}

#[test]
fn beyond_the_light_cone_nothing_arrives() {
    let mut request = glass();
    request["tangential"] = json!([0, 1.2, 0]);
    let answer = solve(&request);
    assert_eq!(answer["total_reflected"], json!([null, null]));
    assert_eq!(answer["power"][3], json!([null, null]));
    assert_eq!(answer["incident"][0]["poynting"], json!(null));
    assert_eq!(answer["transmitted"][0]["propagating"], json!(true));
    // From glass it is total reflection.
    let (from, to) = (request["incident"].clone(), request["transmitted"].clone());
    request["incident"] = to;
    request["transmitted"] = from;
    let answer = solve(&request);
    assert_eq!(answer["total_transmitted"], json!([0.0, 0.0]));
    assert!((float(&answer["total_reflected"][1]) - 1.0).abs() < 1e-15);
}

#[test]
fn metal_mixes_the_waves_of_a_crystal() {
    let request = json!({
        "incident": {
            "permittivity": [[2.5, 0.3, 0.1], [0.3, [2.2, 0], 0.0], [0.1, 0, 2.1]],
            "permeability": 1
        },
        "transmitted": "metal",
        "normal": [0, 0, 1],
        "tangential": [0.3, 0.2, 0]
    });
    let answer = solve(&request);
    assert_eq!(answer["transmitted"], json!([]));
    assert_eq!(answer["power"].as_array().map(Vec::len), Some(2));
    assert_eq!(answer["amplitudes"].as_array().map(Vec::len), Some(2));
    assert_eq!(answer["jones"], json!(null));
    for column in 0..2 {
        let sum: f64 = (0..2).map(|row| float(&answer["power"][row][column])).sum();
        assert!((sum - 1.0).abs() < 1e-14);
        assert_eq!(answer["total_transmitted"][column], json!(0.0));
    }
    assert!(float(&answer["power"][0][1]) > 1e-6);
}

#[test]
fn absorbing_media_take_what_they_do_not_reflect() {
    let mut request = glass();
    request["transmitted"]["permittivity"] = json!([-10.0, 1.5]);
    request["tangential"] = json!([0, 0.5, 0]);
    let answer = solve(&request);
    for column in 0..2 {
        let sum =
            float(&answer["total_reflected"][column]) + float(&answer["total_transmitted"][column]);
        assert!((sum - 1.0).abs() < 1e-14);
    }
}

#[test]
fn errors_name_the_place() {
    let changed = |path: &str, value: Value| {
        let mut request = glass();
        *request.pointer_mut(path).expect("a key") = value;
        request
    };
    let message = refusal(&json!([glass(), changed("/normal", json!([0, 0, 0]))]));
    assert_eq!(message, "[1].normal: the normal is zero");
    let message = refusal(&changed("/tangential", json!([1e-6, 0, 0])));
    assert!(message.starts_with("tangential: the normal part is 1e-6"), "{message}");
    let message = refusal(&changed("/tangential", json!([0, 1e154, 0])));
    assert_eq!(message, "tangential: the vector is 1e154 long; at most 1e6 is allowed");
    let skew = json!([[1, 2, 0], [0, 1, 0], [0, 0, 1]]);
    let message = refusal(&changed("/incident/permittivity", skew));
    assert_eq!(message, "incident: the permittivity tensor is not symmetric");
    let message =
        refusal(&changed("/incident/permittivity", json!([[1, 0, 0], [0, "x", 0], [0, 0, 1]])));
    assert_eq!(message, "incident.permittivity[1][1]: expected a finite number, found \"x\"");
    let message = refusal(&changed("/transmitted", json!("wood")));
    assert!(message.contains("metal"), "{message}");
    let message = refusal(&changed("/transmitted/permeability", json!(0)));
    assert!(message.contains("singular"), "{message}");
    let message = refusal(&changed("/transmitted/permittivity", json!([2.0, -0.1])));
    assert!(message.contains("gain"), "{message}");
    let mut request = glass();
    request["tangental"] = json!([0, 0, 0]);
    assert!(refusal(&request).contains("did you mean `tangential`?"));
    assert!(refusal(&json!({"incident": 1})).contains("missing"));
    assert!(refusal(&json!(3)).contains("expected an object"));
    for text in ["{", "nonsense", "", "[nonsense]", "[{}"] {
        let refused = solve_interfaces(text).expect_err("no JSON").to_string();
        let expected = text == "[{}" || refused.contains("; expected {\"incident\": M, ");
        assert!(expected, "{text}: {refused}");
    }
}
