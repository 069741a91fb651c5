//! The folder as one file, which opens without a web server. From a file a browser loads neither modules nor workers nor
//! WebAssembly; so the modules are addresses that hold their text, the worker is a text of which the page makes one, and what is
//! compiled is packed as text, too.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::GzEncoder;
use std::fs;
use std::io::{self, Write};
use std::path::Path;

/// What the page may do: nothing is loaded.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline' data: 'wasm-unsafe-eval'; worker-src blob:; \
                      style-src 'unsafe-inline'; img-src blob: data:; base-uri 'none'; form-action 'none'";

/// Writes the file.
pub fn write(folder: &Path, file: &Path) -> io::Result<()> {
    let read = |name: &str| fs::read_to_string(folder.join(name));
    let mut modules = Vec::new();
    for entry in fs::read_dir(folder)? {
        let name = entry?.file_name().to_string_lossy().into_owned();
        if name.ends_with(".js") && !["worker.js", "cloakroom.js"].contains(&&*name) {
            // An address that holds a text has no neighbours.
            let text = read(&name)?.replace("from \"./", "from \"page/");
            let address = format!("data:text/javascript;base64,{}", STANDARD.encode(text));
            modules.push(format!("\"page/{name}\":\"{address}\""));
        }
    }
    modules.sort();
    let icon = format!("data:image/svg+xml;base64,{}", STANDARD.encode(read("icon.svg")?));
    let mut packed = GzEncoder::new(Vec::new(), Compression::best());
    packed.write_all(&fs::read(folder.join("cloakroom_bg.wasm"))?)?;
    let compiled = STANDARD.encode(packed.finish()?);
    let worker = format!("{}\n{}", read("cloakroom.js")?, read("worker.js")?);
    let page: String = read("index.html")?
        .lines()
        .filter(|line| !line.contains("modulepreload") && !line.contains("src=\"line.js\""))
        .map(|line| match line.trim() {
            "<link rel=\"stylesheet\" href=\"style.css\">" => {
                Ok(format!("<style>\n{}</style>\n", read("style.css")?))
            }
            "<script type=\"module\" src=\"main.js\"></script>" => Ok(format!(
                "<script type=\"importmap\">{{\"imports\":{{{}}}}}</script>\n\
                 <script type=\"text/plain\" id=\"worker\">\n{worker}</script>\n\
                 <script type=\"text/plain\" id=\"compiled\">{compiled}</script>\n\
                 <script type=\"module\">import \"page/main.js\";</script>\n",
                modules.join(","),
            )),
            line if line.contains("Content-Security-Policy") => {
                Ok(format!("<meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">\n"))
            }
            _ => {
                Ok(format!("{}\n", line.replace("href=\"icon.svg\"", &format!("href=\"{icon}\""))))
            }
        })
        .collect::<io::Result<_>>()?;
    fs::write(file, page)
}
