//! A key that is chosen so that a computed fact of its device stays what it is: designs at equal
//! hidden area.

use crate::device::{FactValue, Show};
use crate::keys::{hint, number_text, quoted};
use crate::scene::{DeviceSettings, Scene};

/// A key of a device that follows the swept ones, so that a computed fact of the device stays what
/// it is in the scene as given.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Constraint {
    /// The key, as in `device.0.w`.
    pub key: String,
    /// The fact, as in `cloaked_area_cm2`.
    pub fact: String,
    /// The number of the device in the scene.
    #[serde(skip)]
    device: usize,
}

/// Why a fact cannot be held.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("--hold {text}: {problem}")]
pub struct ConstraintError {
    /// The key, or all that was written where there is none in it.
    pub text: String,
    /// What is wrong with it.
    pub problem: String,
}

/// Factors between neighbouring trial values: the eighth root of 2, over six octaves to either
/// side.
const TRIALS_AN_OCTAVE: i32 = 8;
const OCTAVES: i32 = 6;

impl Constraint {
    /// Reads `device.N.KEY=FACT`.
    ///
    /// # Errors
    ///
    /// If it is written otherwise.
    pub fn parse(text: &str) -> Result<Self, ConstraintError> {
        let read = || {
            let (key, fact) = text.split_once('=')?;
            let (key, fact) = (key.trim(), fact.trim());
            let (number, name) = key.strip_prefix("device.")?.split_once('.')?;
            let sound = !name.is_empty() && !fact.is_empty();
            Some(Self { key: key.to_owned(), fact: fact.to_owned(), device: number.parse().ok()? })
                .filter(|_| sound)
        };
        read().ok_or_else(|| ConstraintError {
            text: text.to_owned(),
            problem: "write device.N.KEY=FACT, as in device.0.w=cloaked_area_cm2".to_owned(),
        })
    }

    pub(super) fn refused(&self, problem: impl Into<String>) -> ConstraintError {
        ConstraintError { text: self.key.clone(), problem: problem.into() }
    }

    /// The name of the key in its device.
    fn name(&self) -> &str {
        self.key.rsplit('.').next().unwrap_or(&self.key)
    }

    fn device<'s>(&self, scene: &'s Scene) -> Result<&'s DeviceSettings, ConstraintError> {
        scene.devices.get(self.device).ok_or_else(|| {
            let device = self.device;
            self.refused(format!("the scene has no device {device} (devices are counted from 0)"))
        })
    }

    /// The fact as it is in a scene.
    pub(super) fn target(&self, scene: &Scene) -> Result<f64, ConstraintError> {
        let device = self.device(scene)?;
        self.start(device)?;
        fact(device, &self.fact).ok_or_else(|| {
            let facts = device.facts();
            let numbers = facts.iter().filter(|fact| matches!(fact.value, FactValue::Number(_)));
            let known: Vec<&str> = numbers.map(|fact| fact.name).collect();
            let hint = hint(&self.fact, &known, "known ones");
            let (kind, fact) = (device.kind(), quoted(&self.fact, '`'));
            self.refused(format!("a {kind} has no computed number {fact}{hint}"))
        })
    }

    /// The value of the key from which the search starts.
    fn start(&self, device: &DeviceSettings) -> Result<f64, ConstraintError> {
        let keys = device.device.table().keys();
        if !keys.iter().any(|key| key.name == self.name()) {
            let known: Vec<&str> = keys.iter().map(|key| key.name).collect();
            let hint = hint(self.name(), &known, "its keys");
            let kind = device.kind();
            return Err(
                self.refused(format!("a {kind} has no key {}{hint}", quoted(self.name(), '`')))
            );
        }
        let number = device.device.table().get(self.name()).and_then(|value| value.as_number());
        number
            .filter(|number| *number > 0.0)
            .ok_or_else(|| self.refused("the key must be a number above 0 in the scene"))
    }

    /// The value of the key with which the fact is `target` in a scene in which all other keys are
    /// set.
    pub(super) fn solve(
        &self,
        scene: &Scene,
        target: f64,
        settings: &[String],
    ) -> Result<f64, ConstraintError> {
        let mut device = self.device(scene)?.clone();
        let start = self.start(&device)?;
        let mut excess = |value: f64| {
            device.device.table_mut().set(self.name(), value.into()).ok()?;
            fact(&device, &self.fact).map(|fact| fact - target)
        };
        let value = |k: i32| start * 2f64.powf(f64::from(k) / f64::from(TRIALS_AN_OCTAVE));
        let none = || {
            let end = |side: i32| number_text(value(side * OCTAVES * TRIALS_AN_OCTAVE));
            let (low, high, fact, target) = (end(-1), end(1), &self.fact, number_text(target));
            let with = if settings.is_empty() { "" } else { " with " };
            let settings = settings.join(", ");
            self.refused(format!(
                "no value from {low} to {high} keeps {fact} at {target}{with}{settings}"
            ))
        };
        let mut bracket = None;
        // Away from where it is, to either side in turn.
        for k in 0..OCTAVES * TRIALS_AN_OCTAVE {
            for (from, to) in [(k, k + 1), (-k, -k - 1)] {
                let (from, to) = (value(from), value(to));
                if let (Some(a), Some(b)) = (excess(from), excess(to)) {
                    if a == 0.0 {
                        return Ok(from);
                    }
                    if bracket.is_none() && (a > 0.0) != (b > 0.0) {
                        bracket = Some((from, to, a > 0.0));
                    }
                }
            }
            if bracket.is_some() {
                break;
            }
        }
        let (mut from, mut to, positive) = bracket.ok_or_else(none)?;
        while (to - from).abs() > 4.0 * f64::EPSILON * start.max(to.abs()) {
            let middle = 0.5 * (from + to);
            if middle == from || middle == to {
                break;
            }
            let excess = excess(middle).ok_or_else(none)?;
            if (excess > 0.0) == positive { from = middle } else { to = middle }
        }
        Ok(0.5 * (from + to))
    }
}

/// A computed number of a device, if it can be built.
fn fact(device: &DeviceSettings, name: &str) -> Option<f64> {
    device.built(Show::Cloak).ok()?;
    device.facts().into_iter().find_map(|fact| match fact.value {
        FactValue::Number(number) if fact.name == name => Some(number),
        _ => None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene_file;
    use std::path::Path;

    fn scene(text: &str) -> Scene {
        scene_file::parse(text, "test", Path::new(""), &[]).expect("a scene").scene
    }

    #[test]
    fn a_thinner_higher_bump_hides_the_same_area() {
        let hold = Constraint::parse("device.0.w=cloaked_area_cm2").expect("a hold");
        let base = scene("[[device]]\nkind = \"double-gaussian-cloak\"\n");
        let target = hold.target(&base).expect("a fact");
        for h in [2.0, 4.25, 6.0, 8.0] {
            let other = scene(&format!("[[device]]\nkind = \"double-gaussian-cloak\"\nh = {h}\n"));
            // 2 h (sqrt(pi) w - h) = A.
            let exact = (0.5 * target / h + h) / std::f64::consts::PI.sqrt();
            let found = hold.solve(&other, target, &[]);
            // Beyond h/w = 0.886 there is no such map.
            if h / exact > 0.886 {
                let message = found.expect_err("no such map").to_string();
                assert!(message.contains("no value from"), "{message}");
            } else {
                let found = found.expect("a width");
                assert!((found - exact).abs() < 1e-12, "h = {h}: {found} {exact}");
            }
        }
        // A fact that needs no solving for is met at once.
        assert_eq!(hold.solve(&base, target, &[]), Ok(10.02));
    }

    #[test]
    fn what_cannot_be_held_is_refused() {
        for text in ["w=a", "device.0.w", "device.x.w=a", "device.0.=a", "device.0.w="] {
            assert!(Constraint::parse(text).is_err_and(|e| e.to_string().contains(text)), "{text}");
        }
        let base = scene("[[device]]\nkind = \"square-cloak\"\n");
        let message = |text: &str| {
            let hold = Constraint::parse(text).expect(text);
            hold.target(&base).expect_err(text).to_string()
        };
        assert!(message("device.1.side=a").contains("no device 1"));
        assert!(message("device.0.sid=a").contains("did you mean `side`"));
        assert!(message("device.0.rounded=a").contains("number above 0"));
        assert!(message("device.0.side=cloaked_area").contains("did you mean `cloaked_area_cm2`"));
        let hold = Constraint::parse("device.0.kappa=mirror_width_cm").expect("a hold");
        let message = hold.solve(&base, 25.0, &["device.0.side=9".to_owned()]);
        let message = message.expect_err("it does not depend on it").to_string();
        assert!(message.contains("keeps mirror_width_cm at 25 with device.0.side=9"), "{message}");
    }
}
