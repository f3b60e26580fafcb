//! One HTML file with bearings, module and scripts.

use std::{io::Write, path::Path};

use base64::{Engine as _, engine::general_purpose::STANDARD};
use flate2::{Compression, write::GzEncoder};
use serde_json::json;
use stribeck_scene::scene::Scene;

use crate::{
    bundle::{self, Bundled},
    content::Content,
    error::Error,
};

/// First bytes of a WebAssembly module.
const MAGIC: &[u8] = b"\0asm";

/// The page and its scripts, in the order in which they use each other.
const PAGE: &str = include_str!("../assets/lab.html");
const STYLE: &str = include_str!("../assets/lab.css");
const ENGINE: &str = include_str!("../assets/engine.js");
const SCRIPTS: [(&str, &str); 9] = [
    ("words.js", include_str!("../assets/words.js")),
    ("signals.js", include_str!("../assets/signals.js")),
    ("plots.js", include_str!("../assets/plots.js")),
    ("stage.js", include_str!("../assets/stage.js")),
    ("presets.js", include_str!("../assets/presets.js")),
    ("sound.js", include_str!("../assets/sound.js")),
    ("files.js", include_str!("../assets/files.js")),
    ("driver.js", include_str!("../assets/driver.js")),
    ("lab.js", include_str!("../assets/lab.js")),
];

/// A page.
#[derive(Debug)]
pub struct Page {
    /// The file.
    pub html: String,
    /// Bytes that each scene takes in it.
    pub bytes_of_scenes: Vec<usize>,
    /// Bytes that the module takes in it.
    pub bytes_of_module: usize,
}

/// The module that this program was built with, if it was (feature `embed`, `build.rs`).
pub fn embedded() -> Option<&'static [u8]> {
    #[cfg(embedded)]
    return Some(include_bytes!(env!("STRIBECK_LAB_EMBEDDED")));
    #[cfg(not(embedded))]
    None
}

/// Whether these bytes are those of a module.
pub fn is_module(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC)
}

/// The page of some scenes, which all run in modes there. `module` is this crate, compiled for
/// `wasm32-unknown-unknown`; `runs` is where reductions may be kept; `command` is what would make the page
/// again.
pub fn page(scenes: &[Scene], module: &[u8], runs: Option<&Path>, command: &str) -> Result<Page, Error> {
    let bundled: Vec<Bundled> =
        scenes.iter().map(|scene| bundle::bundle(scene, runs)).collect::<Result<_, _>>()?;
    let packed = |b: &Bundled| {
        Ok([pack(&b.content.to_bytes()?), pack(&bytes(&b.reference)), pack(&in_row(&b.states))])
    };
    let packed: Vec<[String; 3]> = bundled.iter().map(packed).collect::<Result<_, Error>>()?;
    let module = pack(module);
    let facts: Vec<_> = bundled.iter().map(|b| &b.facts).collect();
    let facts = json!({ "bearings": facts, "command": command, "version": env!("CARGO_PKG_VERSION") });
    let mut data = element("facts", "application/json", &facts.to_string().replace("</", "<\\/"));
    for (n, [content, reference, states]) in packed.iter().enumerate() {
        data += &element(&format!("bearing-{n}"), "text/plain", content);
        data += &element(&format!("reference-{n}"), "text/plain", reference);
        data += &element(&format!("states-{n}"), "text/plain", states);
    }
    data += &element("module", "text/plain", &module);
    data += &element("engine", "text/plain", &plain(ENGINE));
    let scripts: Vec<String> = SCRIPTS.iter().map(|(_, text)| plain(text)).collect();
    let html = PAGE.replacen("/*STYLE*/", STYLE, 1).replacen("<!--DATA-->", &data, 1).replacen(
        "/*SCRIPTS*/",
        &format!("{}\n{}", plain(ENGINE), scripts.join("\n")),
        1,
    );
    Ok(Page {
        html,
        bytes_of_scenes: packed.iter().map(|parts| parts.iter().map(String::len).sum()).collect(),
        bytes_of_module: module.len(),
    })
}

/// Data of a scene in a page. `runs` as for [`page`].
pub fn content(scene: &Scene, runs: Option<&Path>) -> Result<Content, Error> {
    Ok(bundle::bundle(scene, runs)?.content)
}

/// A script to be run after the others, without its imports and exports: all names are in one scope.
fn plain(script: &str) -> String {
    let kept = script.lines().filter(|line| !line.starts_with("import "));
    let lines: Vec<&str> = kept.map(|line| line.strip_prefix("export ").unwrap_or(line)).collect();
    lines.join("\n")
}

fn element(id: &str, kind: &str, text: &str) -> String {
    format!("<script id=\"{id}\" type=\"{kind}\">{text}</script>\n")
}

fn bytes(numbers: &[f64]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

/// One after the other, each behind its length.
fn in_row(parts: &[Vec<u8>]) -> Vec<u8> {
    parts.iter().flat_map(|part| [&(part.len() as u32).to_le_bytes()[..], part].concat()).collect()
}

/// Compressed and as text: browsers undo both.
fn pack(bytes: &[u8]) -> String {
    let mut packed = GzEncoder::new(Vec::new(), Compression::best());
    let written = packed.write_all(bytes).and_then(|()| packed.finish());
    STANDARD.encode(written.expect("a vector takes all that is written"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn behaves_a_script_loses_what_joins_it_to_others() {
        let script = "import { a } from \"./a.js\";\nexport const b = a + 1;\nexport function c() {}\n";
        assert_eq!(plain(script), "const b = a + 1;\nfunction c() {}");
    }

    #[test]
    fn invariant_every_script_is_a_module_whose_names_are_its_own() {
        let mut names: Vec<&str> = Vec::new();
        for text in SCRIPTS.iter().map(|(_, text)| *text).chain([ENGINE]) {
            let declared = text.lines().filter_map(|line| {
                let line = line.strip_prefix("export ").unwrap_or(line);
                let rest = ["const ", "let ", "function ", "class ", "async function "]
                    .iter()
                    .find_map(|word| line.strip_prefix(*word))?;
                rest.split(|c: char| !(c.is_alphanumeric() || c == '_')).next()
            });
            names.extend(declared.filter(|name| !name.is_empty()));
        }
        names.sort_unstable();
        let twice: Vec<_> = names.windows(2).filter(|pair| pair[0] == pair[1]).collect();
        assert!(twice.is_empty() && names.len() > 20, "{twice:?}");
    }
}
