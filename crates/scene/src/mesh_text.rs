//! Mesh files as text within a scene: with the files that they include, binary ones in base64.
//!
//! A run holds all of its scene, so that `*INCLUDE` has to be followed when the scene is read. The lines of
//! another file stand between two comments, `** included: part.inp` and `** end of included` (`$` in
//! LS-DYNA's files), by which the reader of meshes finds the file of a line. A binary file is `base64:` and
//! its bytes in that encoding (RFC 4648).

use std::borrow::Cow;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

/// Prefix of a binary file.
const BINARY: &str = "base64:";
/// Files that include files that include files.
const DEEPEST: usize = 20;

/// The bytes of a mesh file from its text in a scene.
///
/// # Errors
/// In words, when the letters of a binary file are damaged.
pub fn bytes(text: &str) -> Result<Cow<'_, [u8]>, String> {
    let Some(letters) = text.strip_prefix(BINARY) else { return Ok(text.as_bytes().into()) };
    let bytes = STANDARD.decode(letters.trim());
    bytes.map(Cow::Owned).map_err(|why| format!("its bytes are damaged in the scene: {why}"))
}

/// Folders from which mesh files may include others, beside their own.
static ALLOWED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Lets mesh files include files below these folders, too, from now on.
pub fn allow(folders: &[PathBuf]) {
    ALLOWED.lock().unwrap_or_else(PoisonError::into_inner).extend_from_slice(folders);
}

/// Names of the files that the text of a mesh holds beside the first one, as they were included.
pub fn included(text: &str) -> Vec<&str> {
    let name =
        |line| str::strip_prefix(line, "** included: ").or_else(|| str::strip_prefix(line, "$ included: "));
    // A binary file includes nothing.
    if text.starts_with(BINARY) { Vec::new() } else { text.lines().filter_map(name).collect() }
}

/// The text of the mesh `file` and of the files that it includes, of at most `most` bytes in all.
pub(crate) fn read(file: &Path, most: u64) -> Result<String, String> {
    let main = bytes_of(file, most)?;
    let extension = file.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    let format = match extension.as_str() {
        "inp" => Includes::Abaqus,
        "k" | "key" | "dyn" => Includes::LsDyna,
        _ if main.contains(&0) => return Ok(format!("{BINARY}{}", STANDARD.encode(main))),
        _ => return Ok(text_of(main)),
    };
    let folder = file.parent().unwrap_or(Path::new("")).to_owned();
    let mut text = Assembled { format, folder, most, out: String::new(), left: most };
    text.left = most.saturating_sub(main.len() as u64);
    text.add(&text_of(main), file, 0)?;
    Ok(text.out)
}

/// Text in any encoding that contains ASCII, whose lines may end as those of old Macintoshes do.
fn text_of(bytes: Vec<u8>) -> String {
    let text = decoded(bytes);
    if text.contains('\r') && !text.contains('\n') { text.replace('\r', "\n") } else { text }
}

/// Anything but UTF-8 is taken for Latin-1, which maps every byte. UTF-16 is recognised by its byte order
/// mark.
fn decoded(bytes: Vec<u8>) -> String {
    let units = |order: fn([u8; 2]) -> u16| {
        let units = bytes[2..].as_chunks().0.iter().map(|pair| order(*pair));
        char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect()
    };
    match bytes.as_slice() {
        [0xff, 0xfe, ..] => return units(u16::from_le_bytes),
        [0xfe, 0xff, ..] => return units(u16::from_be_bytes),
        _ => {}
    }
    let text = String::from_utf8(bytes)
        .unwrap_or_else(|error| error.as_bytes().iter().map(|byte| char::from(*byte)).collect());
    text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text)
}

/// The bytes of a file of at most `most`, or why there are none.
pub(crate) fn bytes_of(file: &Path, most: u64) -> Result<Vec<u8>, String> {
    let open = || -> std::io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        if std::fs::metadata(file)?.is_dir() {
            return Err(std::io::Error::other("it is a folder"));
        }
        File::open(file)?.take(most + 1).read_to_end(&mut bytes)?;
        Ok(bytes)
    };
    let bytes = open().map_err(|why| why.to_string())?;
    if bytes.len() as u64 > most {
        return Err(format!("it is larger than {most} bytes, the limit"));
    }
    Ok(bytes)
}

/// How a format includes files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Includes {
    /// `*INCLUDE, INPUT=name`, and `INPUT=` at cards of nodes, elements and sets.
    Abaqus,
    /// `*INCLUDE`, and names in the lines below.
    LsDyna,
}

impl Includes {
    fn comment(self) -> &'static str {
        if self == Self::Abaqus { "**" } else { "$" }
    }
}

/// A text that grows by the files that it includes.
struct Assembled {
    format: Includes,
    /// Where the main file lies.
    folder: PathBuf,
    most: u64,
    out: String,
    /// Bytes that may still come.
    left: u64,
}

impl Assembled {
    /// Adds the text of `file` and of the files that it includes.
    fn add(&mut self, text: &str, file: &Path, depth: usize) -> Result<(), String> {
        if depth > DEEPEST {
            return Err(format!(
                "files include each other more than {DEEPEST} deep; `{}` is one of them",
                file.display()
            ));
        }
        match self.format {
            Includes::Abaqus => self.add_abaqus(text, file, depth),
            Includes::LsDyna => self.add_lsdyna(text, file, depth),
        }
    }

    fn add_abaqus(&mut self, text: &str, file: &Path, depth: usize) -> Result<(), String> {
        let mut lines = text.lines().peekable();
        while let Some(line) = lines.next() {
            let mut keyword = line.trim().to_owned();
            let Some(name) = keyword.strip_prefix('*').filter(|rest| !rest.starts_with('*')) else {
                self.put(line);
                continue;
            };
            let name = name.split(',').next().unwrap_or_default().trim().to_ascii_uppercase();
            let takes_input = ["INCLUDE", "NODE", "ELEMENT", "NSET", "ELSET"].contains(&name.as_str());
            if !takes_input {
                self.put(line);
                continue;
            }
            let include = name == "INCLUDE";
            let comment = if include { "** " } else { "" };
            self.put(&format!("{comment}{line}"));
            // The keyword goes on behind a comma at the end.
            while keyword.ends_with(',')
                && let Some(next) =
                    lines.next_if(|next| next.trim().starts_with(|c: char| c.is_ascii_alphabetic()))
            {
                keyword.push_str(next.trim());
                self.put(&format!("{comment}{next}"));
            }
            let input =
                keyword.split(',').filter_map(|part| part.split_once('=')).find_map(|(key, value)| {
                    key.trim()
                        .eq_ignore_ascii_case("INPUT")
                        .then(|| value.trim().trim_matches('"').to_owned())
                });
            match input {
                Some(input) => self.include(&input, file, depth)?,
                None if include => return Err("an `*INCLUDE` lacks `INPUT=`".to_owned()),
                None => {}
            }
        }
        Ok(())
    }

    fn add_lsdyna(&mut self, text: &str, file: &Path, depth: usize) -> Result<(), String> {
        let mut names_follow = false;
        let mut name = String::new();
        for line in text.lines() {
            let keyword = line.strip_prefix('*').map(|keyword| keyword.trim().to_ascii_uppercase());
            match keyword.as_deref() {
                // Of an included file it ends only that.
                Some("END") if depth > 0 => break,
                Some("INCLUDE") => {
                    names_follow = true;
                    self.put(&format!("$ {line}"));
                    continue;
                }
                Some(_) => names_follow = false,
                None => {}
            }
            if !names_follow || line.starts_with('$') || line.trim().is_empty() {
                self.put(line);
                continue;
            }
            self.put(&format!("$ {line}"));
            // Long names go on behind a plus at the end.
            if let Some(part) = line.trim().strip_suffix(" +") {
                name.push_str(part.trim());
                continue;
            }
            name.push_str(line.trim());
            self.include(&std::mem::take(&mut name), file, depth)?;
        }
        Ok(())
    }

    /// Adds the file `name`, which counts from the folder of the file that names it, or of the first one.
    fn include(&mut self, name: &str, from: &Path, depth: usize) -> Result<(), String> {
        let path = name.replace('\\', "/");
        let beside = from.parent().unwrap_or(Path::new("")).join(&path);
        let file = if beside.exists() { beside } else { self.folder.join(&path) };
        self.reaches(&file).map_err(|why| format!("it includes `{name}`, {why}"))?;
        let bytes = bytes_of(&file, self.left).map_err(|why| {
            let limit = if why.contains("limit") {
                format!(", and {} bytes are in all", self.most)
            } else {
                String::new()
            };
            format!("it includes `{name}`, which cannot be read: {why}{limit}")
        })?;
        self.left -= bytes.len() as u64;
        let comment = self.format.comment();
        self.put(&format!("{comment} included: {name}"));
        self.add(&text_of(bytes), &file, depth + 1)?;
        self.put(&format!("{comment} end of included"));
        Ok(())
    }

    /// Refuses a file outside of the folder of the first one, unless its folder is allowed: a run, and its page,
    /// hold a copy of it, and somebody else may have written the mesh file.
    fn reaches(&self, file: &Path) -> Result<(), String> {
        // What is missing is told where it is read; links lead to where they lead.
        let Ok(real) = file.canonicalize() else { return Ok(()) };
        let below = |folder: &Path| {
            let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
            folder.canonicalize().is_ok_and(|folder| real.starts_with(folder))
        };
        let allowed = ALLOWED.lock().unwrap_or_else(PoisonError::into_inner);
        if below(&self.folder) || allowed.iter().any(|folder| below(folder)) {
            return Ok(());
        }
        let parent = real.parent().unwrap_or(Path::new("/"));
        Err(format!(
            "which lies outside of its folder: `{}`. A run and its page would hold a copy of it; \
             `--allow-include {}` allows that",
            real.display(),
            parent.display()
        ))
    }

    fn put(&mut self, line: &str) {
        self.out.push_str(line);
        self.out.push('\n');
    }
}

#[cfg(test)]
mod tests {
    use stribeck_testing::{Scratch, assert_refused};

    use super::*;

    #[test]
    fn behaves_included_files_stand_in_their_place() {
        let folder = Scratch::create("includes");
        std::fs::create_dir(folder.join("parts")).expect("a folder");
        for (name, text) in [
            ("main.inp", "*HEADING\n*Include,\n input=\"parts/a.inp\"\n*NSET, NSET=x\n1\n"),
            ("parts/a.inp", "*NODE, INPUT=nodes.txt\n*INCLUDE, INPUT=main_b.inp\n"),
            ("parts/nodes.txt", "1, 0, 0"),
            ("main_b.inp", "** b\r\n"),
            ("loop.inp", "*INCLUDE, INPUT=loop.inp\n"),
            ("main.k", "*KEYWORD\n*INCLUDE\n$ c\nparts/ +\na.k\n*NODE\n*END\n"),
            ("parts/a.k", "*NODE\n       1\n*END\nnever read\n"),
            ("none.inp", "*INCLUDE, INPUT=none.txt\n"),
            ("old.inp", "*INCLUDE, INPUT=main_b.inp\r*NSET, NSET=x\r1\r"),
        ] {
            std::fs::write(folder.join(name), text).expect("written");
        }
        let text = |name: &str| read(&folder.join(name), 10_000);
        assert_eq!(
            text("main.inp").as_deref(),
            Ok("*HEADING\n** *Include,\n**  input=\"parts/a.inp\"\n** included: parts/a.inp\n*NODE, \
                INPUT=nodes.txt\n** included: nodes.txt\n\
                1, 0, 0\n** end of included\n** *INCLUDE, INPUT=main_b.inp\n** included: main_b.inp\n** \
                b\n** end of included\n\
                ** end of included\n*NSET, NSET=x\n1\n")
        );
        assert_eq!(
            text("old.inp").as_deref(),
            Ok("** *INCLUDE, INPUT=main_b.inp\n** included: main_b.inp\n** b\n** end of included\n*NSET, \
                NSET=x\n1\n")
        );
        assert_eq!(
            text("main.k").as_deref(),
            Ok(
                "*KEYWORD\n$ *INCLUDE\n$ c\n$ parts/ +\n$ a.k\n$ included: parts/a.k\n*NODE\n       1\n$ end \
                 of included\n*NODE\n*END\n"
            )
        );
        for (name, words) in
            [("loop.inp", "more than 20 deep"), ("none.inp", "it includes `none.txt`, which cannot")]
        {
            let why = text(name).expect_err(name);
            assert!(why.contains(words), "{why}");
        }
        let why = read(&folder.join("main.inp"), 80).expect_err("too long");
        assert!(why.contains("the limit"), "{why}");
    }

    /// A deck of another person had any readable file copied into the run and its page.
    #[test]
    fn issue_files_outside_of_the_folder_are_not_included() {
        let scratch = Scratch::create("outside");
        let folder = scratch.join("scene");
        std::fs::create_dir_all(folder.join("parts")).expect("a folder");
        let secret = scratch.join("secret.txt");
        let absolute = format!("*INCLUDE, INPUT={}\n", secret.display());
        for (file, text) in [
            (secret.clone(), "** secret\n"),
            (folder.join("up.inp"), "*INCLUDE, INPUT=../secret.txt\n"),
            (folder.join("up.k"), "*INCLUDE\n../secret.txt\n"),
            (folder.join("absolute.inp"), absolute.as_str()),
            (folder.join("nodes.inp"), "*NODE, INPUT=../secret.txt\n"),
            (folder.join("below.inp"), "*INCLUDE, INPUT=parts/a.inp\n"),
            (folder.join("parts/a.inp"), "*INCLUDE, INPUT=../b.inp\n"),
            (folder.join("b.inp"), "** b\n"),
        ] {
            std::fs::write(file, text).expect("written");
        }
        let mut names = vec!["up.inp", "up.k", "absolute.inp", "nodes.inp"];
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink(&secret, folder.join("link.txt")).expect("a link");
            std::fs::write(folder.join("linked.inp"), "*INCLUDE, INPUT=link.txt\n").expect("written");
            names.push("linked.inp");
        }
        for name in names {
            let why = read(&folder.join(name), 10_000).expect_err(name);
            assert!(why.contains("secret.txt") && why.contains("--allow-include"), "{why}");
        }
        let text = read(&folder.join("below.inp"), 10_000).expect("below");
        assert_eq!(included(&text), ["parts/a.inp", "../b.inp"]);
        allow(&[scratch.path().to_owned()]);
        assert!(read(&folder.join("up.inp"), 10_000).expect("allowed").contains("** secret"));
    }

    #[test]
    fn roundtrip_binary_files_and_latin_1() {
        let folder = Scratch::create("binary");
        let binary: Vec<u8> = (0..=255).chain([0, 0, 7]).collect();
        std::fs::write(folder.join("a.msh"), &binary).expect("written");
        let text = read(&folder.join("a.msh"), 1000).expect("read");
        assert_eq!(bytes(&text).as_deref(), Ok(binary.as_slice()));
        assert_refused(bytes("base64:*"), "its bytes are damaged in the scene");
        std::fs::write(folder.join("a.inp"), b"*HEADING\nAu\xdfenring\n").expect("written");
        assert_eq!(read(&folder.join("a.inp"), 1000).as_deref(), Ok("*HEADING\nAu\u{df}enring\n"));
        let wide: Vec<u8> = "\u{feff}*NODE\n".encode_utf16().flat_map(u16::to_le_bytes).collect();
        std::fs::write(folder.join("a.inp"), wide).expect("written");
        assert_eq!(read(&folder.join("a.inp"), 1000).as_deref(), Ok("*NODE\n"));
    }
}
