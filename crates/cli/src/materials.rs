//! `cloakroom materials`: the materials that come with the program, and their indices.

use crate::arguments::MaterialsArguments;
use crate::files::{check_outputs, formats, write_each};
use crate::report::{self, Failure, Result, wrote};
use cloakroom::material_file::MaterialFile;
use cloakroom::measure::Sweep;
use cloakroom_figures::{Curve, CurvePoint, DrawingFormat, Plot, PlotPanel};
use optics::material::{IndexLaw, Material, Refraction};
use serde_json::{Value, json};
use std::fmt::Write;
use std::path::Path;

/// The wavelengths of a table, nm: what eyes see.
const SEEN_NM: [f64; 8] = [400.0, 450.0, 500.0, 550.0, 600.0, 650.0, 700.0, 750.0];

/// Points of a plotted curve, and the wavelengths from where to where, nm, if the law holds there.
const POINTS: u32 = 361;
const PLOTTED_NM: [f64; 2] = [380.0, 780.0];

const UM_PER_NM: f64 = 1e-3;

/// Lists the materials, or prints the indices of one.
pub fn run(arguments: &MaterialsArguments) -> Result<()> {
    let Some(name) = &arguments.name else { return list(arguments) };
    let plots = formats(&arguments.plots, DrawingFormat::of)?;
    check_outputs(&arguments.plots, &[name.into()])?;
    let material = found(name)?;
    let waves = waves(&material);
    let wavelengths = wavelengths(arguments.wavelengths.as_deref(), &waves)?;
    let at = |(wave, law): &(&'static str, &IndexLaw)| {
        let refraction = |nm: &f64| {
            let found = law.at(nm * UM_PER_NM);
            found.map_err(|error| Failure::Failed(format!("{name}: {error}")))
        };
        Ok((*wave, wavelengths.iter().map(refraction).collect::<Result<Vec<_>>>()?))
    };
    let rows: Vec<(&str, Vec<Refraction>)> = waves.iter().map(at).collect::<Result<_>>()?;
    if arguments.json {
        let mut object = described(name, &material);
        object["wavelength_nm"] = json!(wavelengths);
        for (wave, indices) in &rows {
            object[wave] = numbers(indices);
        }
        report::print_json(&object)?;
    } else {
        report::print(&table(name, &material, &wavelengths, &rows)?)?;
    }
    write_each(plots, |path, format| plot(name, &waves, format, path))
}

fn list(arguments: &MaterialsArguments) -> Result<()> {
    let materials = Material::NAMES.iter().filter_map(|name| Some((*name, Material::named(name)?)));
    if arguments.json {
        let list: Vec<Value> =
            materials.map(|(name, material)| described(name, &material)).collect();
        return report::print_json(&json!({ "materials": list }));
    }
    let mut text = String::new();
    for (name, material) in materials {
        let [least, most] = range_nm(&material.ordinary);
        let crystal = if material.extraordinary.is_some() { ", uniaxial" } else { "" };
        writeln!(text, "{name:<20} {}{crystal}, {least} to {most} nm", material.title)?;
        writeln!(text, "{:<20} {}", "", material.source)?;
    }
    report::print(&text)
}

/// The material of a name or a file.
fn found(name: &str) -> Result<Material> {
    if let Some(material) = Material::named(name) {
        return Ok(material);
    }
    let path = Path::new(name);
    if path
        .extension()
        .is_some_and(|ending| ["yml", "yaml"].iter().any(|yml| ending.eq_ignore_ascii_case(yml)))
    {
        return Ok(MaterialFile::read(path).map_err(Failure::Failed)?.material().clone());
    }
    let hint = cloakroom::keys::hint(name, &Material::NAMES, "there are");
    Err(Failure::Usage(format!("there is no material `{name}` (a file's name ends in .yml){hint}")))
}

/// The waves of a material, by their names, and their laws.
fn waves(material: &Material) -> Vec<(&'static str, &IndexLaw)> {
    match &material.extraordinary {
        None => vec![("index", &material.ordinary)],
        Some(law) => vec![("ordinary", &material.ordinary), ("extraordinary", law)],
    }
}

fn range_nm(law: &IndexLaw) -> [f64; 2] {
    law.range_um.map(|um| (um * 1e6).round() / 1e3)
}

fn wavelengths(asked: Option<&str>, waves: &[(&str, &IndexLaw)]) -> Result<Vec<f64>> {
    let Some(text) = asked else {
        let holds = |nm: &f64| waves.iter().all(|(_, law)| law.at(nm * UM_PER_NM).is_ok());
        return Ok(SEEN_NM.into_iter().filter(holds).collect());
    };
    let wrong = || {
        Failure::Usage(format!(
            "--at {text}: write wavelengths in nm, such as 400..700:50 or 488,590"
        ))
    };
    let sweep = Sweep::parse(&format!("at={text}")).map_err(|_| wrong())?;
    let numbers = sweep.numbers().filter(|numbers| numbers.iter().all(|nm| *nm > 0.0));
    numbers.ok_or_else(wrong)
}

fn described(name: &str, material: &Material) -> Value {
    json!({
        "name": name,
        "title": material.title,
        "source": material.source,
        "range_nm": range_nm(&material.ordinary),
        "uniaxial": material.extraordinary.is_some(),
    })
}

fn numbers(indices: &[Refraction]) -> Value {
    let all = |part: fn(&Refraction) -> f64| indices.iter().map(part).collect::<Vec<f64>>();
    json!({
        "n": all(|found| found.index.re),
        "k": all(|found| found.index.im),
        "n_g": all(|found| found.group_index.re),
    })
}

fn table(
    name: &str,
    material: &Material,
    wavelengths: &[f64],
    rows: &[(&str, Vec<Refraction>)],
) -> Result<String> {
    let mut text = String::new();
    let [least, most] = range_nm(&material.ordinary);
    writeln!(text, "{name}: {}, {least} to {most} nm\n{}\n", material.title, material.source)?;
    write!(text, "{:>10}", "nm")?;
    for (wave, _) in rows {
        let suffix = match *wave {
            "ordinary" => "_o",
            "extraordinary" => "_e",
            _ => "",
        };
        for column in ["n", "k", "n_g"] {
            write!(text, " {:>11}", format!("{column}{suffix}"))?;
        }
    }
    writeln!(text)?;
    for (i, nm) in wavelengths.iter().enumerate() {
        write!(text, "{nm:>10}")?;
        for (_, indices) in rows {
            let Refraction { index, group_index } = indices[i];
            let k = if index.im == 0.0 { "0".to_owned() } else { format!("{:.4e}", index.im) };
            write!(text, " {:>11.6} {k:>11} {:>11.6}", index.re, group_index.re)?;
        }
        writeln!(text)?;
    }
    Ok(text)
}

/// Draws n, the group index and, where the material absorbs, k.
fn plot(
    name: &str,
    waves: &[(&'static str, &IndexLaw)],
    format: DrawingFormat,
    path: &Path,
) -> Result<()> {
    let ranges = waves.iter().map(|(_, law)| range_nm(law));
    let [least, most] = ranges.fold([0.0, f64::INFINITY], |[least, most]: [f64; 2], [from, to]| {
        [least.max(from), most.min(to)]
    });
    let seen = [least.max(PLOTTED_NM[0]), most.min(PLOTTED_NM[1])];
    let [from, to] = if seen[0] < seen[1] { seen } else { [least, most] };
    let curve = |part: fn(&Refraction) -> f64| {
        let point = |law: &IndexLaw, i: u32| {
            let x = from + (to - from) * f64::from(i) / f64::from(POINTS - 1);
            let y = law.at(x * UM_PER_NM).map_or(f64::NAN, |found| part(&found));
            CurvePoint { x, y, error: 0.0 }
        };
        let curve = |(wave, law): &(&'static str, &IndexLaw)| Curve {
            label: (*wave).to_owned(),
            points: (0..POINTS).map(|i| point(law, i)).collect(),
        };
        waves.iter().map(curve).collect::<Vec<_>>()
    };
    let panel = |title: &str, part| PlotPanel {
        title: title.to_owned(),
        rounding: 0.0,
        curves: curve(part),
    };
    let mut panels = vec![
        panel("Index of refraction n", |found| found.index.re),
        panel("Group index", |found| found.group_index.re),
    ];
    if waves
        .iter()
        .any(|(_, law)| law.at(0.5 * (from + to) * UM_PER_NM).is_ok_and(|at| at.index.im != 0.0))
    {
        panels.insert(1, panel("Extinction coefficient k", |found| found.index.im));
    }
    let plot = Plot { axis: "Wavelength (nm)".to_owned(), categories: Vec::new(), panels };
    let drawing = plot.draw();
    // On paper, 600 an inch.
    let pixels =
        (drawing.size * drawing.mm * 600.0 / 25.4).round().to_array().map(|side| side as u32);
    drawing.write(format, &format!("Refraction of {name}"), &[], pixels, path)?;
    wrote(path);
    Ok(())
}
