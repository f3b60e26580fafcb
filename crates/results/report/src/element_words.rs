//! Pages of a ball bearing call its rolling elements balls.
//!
//! The texts of all pages are written for rollers. This pass goes over a finished page or drawing and
//! replaces the word where people read it: in text, in names for screen readers, and in the labels of charts.
//! Code, scenes, scripts, channels such as `roller_1` and the keys of data stay as they are.

use stribeck_scene::scene::Scene;
use stribeck_theory::catalogue::Element;

/// The word for a scene's rolling elements.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ElementWords {
    Rollers,
    Balls,
}

/// Elements whose content is no prose.
const NO_PROSE: [&str; 5] = ["script", "style", "code", "pre", "textarea"];

/// Attributes that are read aloud or shown.
const SHOWN: [&str; 3] = ["aria-label=\"", "title=\"", "alt=\""];

impl ElementWords {
    /// Of the bearing of a scene.
    pub(crate) fn of(scene: &Scene) -> Self {
        if scene.element() == Element::Ball { Self::Balls } else { Self::Rollers }
    }

    /// A page or an SVG in these words.
    pub(crate) fn markup(self, page: String) -> String {
        if self == Self::Rollers {
            return page;
        }
        let mut out = String::with_capacity(page.len());
        let mut rest = page.as_str();
        while let Some(start) = rest.find('<') {
            out += &reword(&rest[..start], false);
            rest = &rest[start..];
            let end = rest.find('>').map_or(rest.len(), |at| at + 1);
            let tag = &rest[..end];
            out += &attributes(tag);
            rest = &rest[end..];
            let Some(name) = NO_PROSE.into_iter().find(|name| opens(tag, name)) else { continue };
            let end = rest.find(&format!("</{name}")).unwrap_or(rest.len());
            if tag.contains("application/json") {
                out += &reword(&rest[..end], true);
            } else {
                out += &rest[..end];
            }
            rest = &rest[end..];
        }
        out + &reword(rest, false)
    }
}

/// Whether `tag` opens an element of this name.
fn opens(tag: &str, name: &str) -> bool {
    tag[1..].strip_prefix(name).is_some_and(|rest| rest.starts_with([' ', '>', '\n']))
}

/// A tag with the attributes that people read in the new words.
fn attributes(tag: &str) -> String {
    let mut out = String::with_capacity(tag.len());
    let mut rest = tag;
    let next = |rest: &str| SHOWN.iter().filter_map(|name| Some(rest.find(name)? + name.len())).min();
    while let Some(start) = next(rest) {
        out += &rest[..start];
        rest = &rest[start..];
        let end = rest.find('"').unwrap_or(rest.len());
        out += &reword(&rest[..end], false);
        rest = &rest[end..];
    }
    out + rest
}

/// Text with balls for rollers, word by word; in data the keys of objects stay.
fn reword(text: &str, is_data: bool) -> String {
    let mut out = String::with_capacity(text.len());
    let mut from = 0;
    for (at, found) in text.match_indices("oller") {
        let Some(start) = at.checked_sub(1) else { continue };
        let (ball, balls) = match &text.as_bytes()[start] {
            b'r' => ("ball", "balls"),
            b'R' => ("Ball", "Balls"),
            _ => continue,
        };
        let plural = text[at + found.len()..].starts_with('s');
        let end = at + found.len() + usize::from(plural);
        let is_word = !text[..start].ends_with(joins) && !text[end..].starts_with(joins);
        if !is_word || (is_data && text[end..].starts_with("\":")) {
            continue;
        }
        out += &text[from..start];
        out += if plural { balls } else { ball };
        from = end;
    }
    out + &text[from..]
}

/// Characters beside which a word is a part of a name, or of encoded numbers.
fn joins(c: char) -> bool {
    c.is_alphanumeric() || "_-+/=".contains(c)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn behaves_people_read_of_balls_and_programs_of_rollers() {
        let page = "<p title=\"a roller\">Rollers pass; roller 3, <code>bearing.rollers</code>, roller_1.</p>\
                    <pre>roller</pre><figure id=\"roller\"><script>roller</script>\
                    <script type=\"application/json\">{\"rollers\":9,\"name\":\"roller 3\"}</script>";
        let balls = "<p title=\"a ball\">Balls pass; ball 3, <code>bearing.rollers</code>, roller_1.</p>\
                     <pre>roller</pre><figure id=\"roller\"><script>roller</script>\
                     <script type=\"application/json\">{\"rollers\":9,\"name\":\"ball 3\"}</script>";
        assert_eq!(ElementWords::Balls.markup(page.to_owned()), balls);
        assert_eq!(ElementWords::Rollers.markup(page.to_owned()), page);
    }

    #[test]
    fn behaves_the_scene_decides() {
        let of = |text: &str| ElementWords::of(&Scene::parse(text, "here").expect("known"));
        assert_eq!(of("(bearing: \"6205\")"), ElementWords::Balls);
        assert_eq!(of("(bearing: \"NU 205\")"), ElementWords::Rollers);
    }
}
