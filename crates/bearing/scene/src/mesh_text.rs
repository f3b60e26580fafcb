//! Mesh files as text within a scene, so that a run holds all of it. A binary file is `base64:` and its bytes in
//! that encoding (RFC 4648).

use std::borrow::Cow;
use std::fs::File;
use std::io::Read;
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

/// Prefix of a binary file.
const BINARY: &str = "base64:";

/// The bytes of a mesh file from its text in a scene.
///
/// # Errors
/// In words, when the letters of a binary file are damaged.
pub fn bytes(text: &str) -> Result<Cow<'_, [u8]>, String> {
    let Some(letters) = text.strip_prefix(BINARY) else { return Ok(text.as_bytes().into()) };
    let bytes = STANDARD.decode(letters.trim());
    bytes.map(Cow::Owned).map_err(|why| format!("its bytes are damaged in the scene: {why}"))
}

/// Why a file of this name is read as no mesh, and what to do; none where it may be one.
pub(crate) fn refused_by_name(file: &str) -> Option<[&'static str; 2]> {
    let extension = Path::new(file).extension().and_then(|e| e.to_str()).unwrap_or_default();
    match extension.to_ascii_lowercase().as_str() {
        "msh" | "inp" => None,
        "k" | "key" | "dyn" => Some([
            "LS-DYNA decks are not read",
            "write it as Abaqus `.inp` or Gmsh `.msh` from the program that meshed it; Gmsh and meshio write both",
        ]),
        _ => Some([
            "its name ends in neither `.msh` nor `.inp`",
            "name it by its format, or write it as one of them",
        ]),
    }
}

/// The text of the mesh `file`, of at most `most` bytes.
pub(crate) fn read(file: &Path, most: u64) -> Result<String, String> {
    let bytes = bytes_of(file, most)?;
    let abaqus = file.extension().is_some_and(|end| end.eq_ignore_ascii_case("inp"));
    let binary = !abaqus && bytes.contains(&0);
    Ok(if binary { format!("{BINARY}{}", STANDARD.encode(bytes)) } else { text_of(bytes) })
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

#[cfg(test)]
mod tests {
    use stribeck_testing::Scratch;

    use super::*;

    #[test]
    fn behaves_texts_of_all_encodings_are_read_and_long_ones_refused() {
        let folder = Scratch::create("mesh_text");
        let utf16: Vec<u8> = "\u{feff}*NODE\n".encode_utf16().flat_map(u16::to_le_bytes).collect();
        for (name, bytes, text) in [
            ("mac.inp", &b"*NODE\r1, 0, 0\r"[..], "*NODE\n1, 0, 0\n"),
            ("latin.inp", b"** \xfc\n", "** \u{fc}\n"),
            ("wide.INP", &utf16, "*NODE\n"),
            ("binary.msh", b"a\0b", "base64:YQBi"),
        ] {
            std::fs::write(folder.join(name), bytes).expect("written");
            assert_eq!(read(&folder.join(name), 100).as_deref(), Ok(text), "{name}");
            let why = read(&folder.join(name), 2).expect_err(name);
            assert!(why.contains("2 bytes, the limit"), "{why}");
        }
    }

    #[test]
    fn refuses_ls_dyna_by_name_with_the_way_through() {
        for name in ["a.k", "b.KEY", "c/d.dyn"] {
            let [why, instead] = refused_by_name(name).expect(name);
            assert!(why.contains("LS-DYNA") && instead.contains("`.inp`") && instead.contains("`.msh`"));
        }
        assert_eq!([refused_by_name("a.msh"), refused_by_name("b.INP")], [None, None]);
        assert!(refused_by_name("mesh").is_some());
    }
}
