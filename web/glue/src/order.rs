//! The functions of a compiled page in the order of their names. What a browser loads is compressed, and that finds again only what is near:
//! so the many copies of a generic function, which hardly differ, stand side by side. Nothing else changes.

use std::convert::Infallible;
use wasm_encoder::reencode::{Error, Reencode};
use wasm_encoder::{CodeSection, FunctionSection, Module};
use wasmparser::{
    CodeSectionReader, CustomSectionReader, FunctionBody, FunctionSectionReader, KnownCustom, Name,
    Parser, Payload, TypeRef,
};

/// Puts functions into their places.
struct Sorted {
    /// How many functions are imported: they come first, as they are.
    imported: u32,
    /// The functions that come first, second and so on, by their old places.
    order: Vec<usize>,
    /// The new places of the old ones.
    places: Vec<u32>,
}

impl Reencode for Sorted {
    type Error = Infallible;

    fn function_index(&mut self, old: u32) -> Result<u32, Error> {
        let own = old.checked_sub(self.imported);
        Ok(own.map_or(old, |own| self.imported + self.places[own as usize]))
    }

    fn parse_function_section(
        &mut self,
        to: &mut FunctionSection,
        from: FunctionSectionReader<'_>,
    ) -> Result<(), Error> {
        let types: Vec<u32> = from.into_iter().collect::<Result<_, _>>()?;
        for old in &self.order {
            to.function(types[*old]);
        }
        Ok(())
    }

    fn parse_code_section(
        &mut self,
        to: &mut CodeSection,
        from: CodeSectionReader<'_>,
    ) -> Result<(), Error> {
        let bodies: Vec<FunctionBody<'_>> = from.into_iter().collect::<Result<_, _>>()?;
        for old in self.order.clone() {
            self.parse_function_body(to, bodies[old].clone())?;
        }
        Ok(())
    }

    fn parse_custom_section(
        &mut self,
        to: &mut Module,
        section: CustomSectionReader<'_>,
    ) -> Result<(), Error> {
        // The names have served.
        if !matches!(section.as_known(), KnownCustom::Name(_)) {
            to.section(&self.custom_section(section)?);
        }
        Ok(())
    }
}

/// The module with its functions in the order of their names, and without these.
pub fn by_name(module: &[u8]) -> Result<Vec<u8>, String> {
    let mut sorted = order_of(module).map_err(|error| error.to_string())?;
    let mut to = Module::new();
    sorted
        .parse_core_module(&mut to, Parser::new(0), module)
        .map_err(|error| format!("{error}"))?;
    Ok(to.finish())
}

fn order_of(module: &[u8]) -> Result<Sorted, wasmparser::BinaryReaderError> {
    let mut imported = 0;
    let mut lengths = Vec::new();
    let mut names = Vec::new();
    for payload in Parser::new(0).parse_all(module) {
        match payload? {
            Payload::ImportSection(imports) => {
                for import in imports.into_imports() {
                    imported += u32::from(matches!(import?.ty, TypeRef::Func(_)));
                }
            }
            Payload::CodeSectionEntry(body) => lengths.push(body.range().len()),
            Payload::CustomSection(section) => {
                if let KnownCustom::Name(subsections) = section.as_known() {
                    for subsection in subsections {
                        if let Name::Function(map) = subsection? {
                            for naming in map {
                                let naming = naming?;
                                names.push((naming.index, naming.name));
                            }
                        }
                    }
                }
            }
            _ => {}
        }
    }
    let mut keys = vec![""; lengths.len()];
    for (index, name) in names {
        if let Some(key) = index.checked_sub(imported).and_then(|own| keys.get_mut(own as usize)) {
            *key = without_hash(name);
        }
    }
    let mut order: Vec<usize> = (0..lengths.len()).collect();
    order.sort_by_key(|old| (keys[*old], lengths[*old], *old));
    let mut places = vec![0; order.len()];
    for (place, old) in (0..).zip(&order) {
        places[*old] = place;
    }
    Ok(Sorted { imported, order, places })
}

/// A name without the hash that tells copies apart, `17h0123456789abcdefE`.
fn without_hash(name: &str) -> &str {
    name.len()
        .checked_sub(20)
        .and_then(|end| name.split_at_checked(end))
        .filter(|(_, hash)| hash.starts_with("17h"))
        .map_or(name, |(rest, _)| rest)
}
