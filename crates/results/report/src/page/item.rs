//! A chart or a picture of a page.

use maud::Markup;

use crate::Error;
use crate::plot::{Figure, Picture, Tab};

/// Width of half a page [px].
pub(crate) const HALF_PAGE_PX: u32 = 540;

#[derive(Debug)]
pub(crate) enum Item {
    Chart(Box<Figure>),
    Picture(Picture),
}

impl Item {
    pub(crate) fn id(&self) -> &str {
        match self {
            Self::Chart(figure) => &figure.id,
            Self::Picture(picture) => &picture.id,
        }
    }

    pub(crate) fn to_svg(&self) -> Result<String, Error> {
        match self {
            Self::Chart(figure) => figure.to_svg(),
            Self::Picture(picture) => Ok(picture.sheet.to_svg()),
        }
    }

    /// As wide as half a page, with letters as large as those of a whole one.
    pub(crate) fn to_narrow_svg(&self) -> Result<String, Error> {
        match self {
            Self::Chart(figure) => Figure { width_px: HALF_PAGE_PX, ..(**figure).clone() }.to_svg(),
            Self::Picture(_) => self.to_svg(),
        }
    }

    pub(crate) fn to_html(&self) -> Result<Markup, Error> {
        match self {
            Self::Chart(figure) => figure.to_html(),
            Self::Picture(picture) => Ok(picture.to_html()),
        }
    }

    /// Its place among figures behind tabs.
    pub(crate) fn tab(&self) -> Option<&Tab> {
        match self {
            Self::Chart(figure) => figure.tab.as_ref(),
            Self::Picture(picture) => picture.tab.as_ref(),
        }
    }

    /// How reliable it is.
    pub(crate) fn note(&self) -> &str {
        match self {
            Self::Chart(figure) => &figure.note,
            Self::Picture(picture) => &picture.note,
        }
    }

    /// The form for the page with another note.
    pub(crate) fn with_note(&self, note: String) -> Result<Markup, Error> {
        match self {
            Self::Chart(figure) => figure.clone().note(note).to_html(),
            Self::Picture(picture) => Ok(Picture { note, ..picture.clone() }.to_html()),
        }
    }
}

pub(crate) fn charts(figures: impl IntoIterator<Item = Figure>) -> impl Iterator<Item = Item> {
    figures.into_iter().map(|figure| Item::Chart(Box::new(figure)))
}

pub(crate) fn drawn(pictures: impl IntoIterator<Item = Picture>) -> impl Iterator<Item = Item> {
    pictures.into_iter().map(Item::Picture)
}
