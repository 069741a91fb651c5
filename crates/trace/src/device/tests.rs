use super::*;
use crate::keys::{Sampled, Samples, ValueRange};

/// What a kind needs to be something.
fn sound(entry: &Entry) -> AnyDevice {
    let mut device = (entry.device)();
    if let AnyDevice::Graded(graded) = &mut device {
        graded.index = Samples::new(&vec![vec![1.5; 4]; 4]).ok().map(Sampled::Here);
    }
    if let AnyDevice::Prisms(prisms) = &mut device {
        let corners = Some(vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
        prisms.prism =
            vec![PrismOfMedium { corners, metal: Metal::Perfect, ..PrismOfMedium::default() }];
    }
    device
}

#[test]
fn a_device_of_a_struct_is_that_of_its_written_keys() {
    for entry in CATALOGUE {
        let device = sound(entry);
        let mut read = (entry.device)();
        for (name, value) in device.table().written() {
            read.table_mut().set(&name, value).expect("as it was written");
        }
        let build = |device: &AnyDevice| {
            let built = device.build(Request::default());
            format!("{:?}", built.unwrap_or_else(|error| panic!("{}: {error}", entry.kind)))
        };
        assert_eq!(build(&device), build(&read), "{}", entry.kind);
        let request = Request::default();
        assert_eq!(device.facts(request), read.facts(request));
        assert_eq!((device.kind(), device.table().keys().len()), (entry.kind, entry.keys.len()));
    }
}

#[test]
fn a_struct_outside_its_limits_is_refused() {
    for entry in CATALOGUE {
        for key in entry.keys.iter().filter(|key| key.limits == ValueRange::LENGTH) {
            for bad in [f64::NAN, 0.0, -1.0, f64::INFINITY] {
                let mut device = sound(entry);
                let value = match (key.default)() {
                    Some(crate::keys::Value::List(_)) => [bad; 3].into(),
                    _ => bad.into(),
                };
                assert!(device.table_mut().put(key.name, &value), "{}", key.name);
                let error = device.build(Request::default()).expect_err(key.name);
                assert_eq!(error.key, Some(key.name), "{}", entry.kind);
            }
        }
    }
}
