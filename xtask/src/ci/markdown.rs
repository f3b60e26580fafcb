//! The little of Markdown that the checks need.

/// Text of every piece of code: the lines of fenced blocks, and the text between backticks elsewhere.
pub(crate) fn code(text: &str) -> Vec<&str> {
    let mut fenced = false;
    let mut found = Vec::new();
    for line in text.lines() {
        if line.trim_start().starts_with("```") {
            fenced = !fenced;
        } else if fenced {
            found.push(line.trim());
        } else {
            found.extend(line.split('`').skip(1).step_by(2));
        }
    }
    found
}

/// Fenced blocks of a language.
pub(crate) fn blocks(text: &str, language: &str) -> Vec<String> {
    let fence = format!("```{language}");
    let mut found: Vec<String> = Vec::new();
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        if line.trim() == fence {
            let block: Vec<&str> = lines.by_ref().take_while(|line| line.trim() != "```").collect();
            found.push(block.join("\n"));
        }
    }
    found
}

/// Targets of links to files, `[text](docs/x.md#section)` → `docs/x.md`, and of pictures; none of links to
/// the network.
pub(crate) fn links(text: &str) -> Vec<&str> {
    let mut targets: Vec<&str> = text.split("](").skip(1).filter_map(|rest| rest.split(')').next()).collect();
    targets.retain(|target| !target.contains("://") && !target.contains(char::is_whitespace));
    targets
        .into_iter()
        .filter_map(|target| target.split('#').next())
        .filter(|file| !file.is_empty())
        .collect()
}

/// Number of a section heading, `## 4.1 Gap` or `## §4.1 Gap` → `4.1`.
pub(crate) fn section_number(line: &str) -> Option<&str> {
    let title = line.strip_prefix('#')?.trim_start_matches('#').trim_start();
    let first = title.trim_start_matches('§').split([' ', '\t']).next()?;
    let number = first.trim_end_matches(['.', ':']);
    let digits = number.starts_with(|c: char| c.is_ascii_digit());
    (digits && number.chars().all(|c| c.is_ascii_digit() || c == '.')).then_some(number)
}

/// Sections cited in `text` as `THEORY §4.1`, also in a list: `THEORY §2, §4.1 and §5`.
pub(crate) fn citations(text: &str) -> Vec<&str> {
    let mut found = Vec::new();
    for (at, _) in text.match_indices("THEORY §") {
        let mut rest = &text[at + "THEORY §".len()..];
        loop {
            let end = rest.find(|c: char| !(c.is_ascii_digit() || c == '.')).unwrap_or(rest.len());
            let number = rest[..end].trim_end_matches('.');
            if number.is_empty() {
                break;
            }
            found.push(number);
            let next = [", §", " and §", ", and §"].iter().find_map(|glue| rest[end..].strip_prefix(glue));
            let Some(next) = next else { break };
            rest = next;
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn behaves_code_is_found_in_fences_and_backticks() {
        let text = "Run `cargo xtask ci` or `x`.\n```sh\ncargo xtask simulate\n```\nno code";
        assert_eq!(code(text), ["cargo xtask ci", "x", "cargo xtask simulate"]);
    }

    #[test]
    fn behaves_blocks_of_a_language() {
        assert_eq!(blocks("a\n```ron\n(\n)\n```\n```sh\nb\n```", "ron"), ["(\n)"]);
    }

    #[test]
    fn behaves_links_to_files() {
        let text = "[a](docs/x.md#part) and ![b](y.svg), [c](https://example.org), [d](#here), `f[0](x, y)`";
        assert_eq!(links(text), ["docs/x.md", "y.svg"]);
    }

    #[test]
    fn behaves_sections_and_their_citations() {
        assert_eq!(section_number("## 4.1 Gap"), Some("4.1"));
        assert_eq!(section_number("### §12. Statics"), Some("12"));
        assert_eq!(section_number("## Contact"), None);
        assert_eq!(section_number("4.1 Gap"), None);
        let text = "See THEORY §4.1. Also THEORY §2, §3.1 and §5; not THEORY §x.";
        assert_eq!(citations(text), ["4.1", "2", "3.1", "5"]);
    }
}
