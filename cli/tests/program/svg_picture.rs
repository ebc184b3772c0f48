//! SVG files as a viewer shows them.

use std::fs;
use std::path::Path;

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::roxmltree::{Document, Node};
use resvg::usvg::{Options, ShapeRendering, Tree};

use crate::png_picture::Picture;

/// Lines of a drawing.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct DrawnLines {
    /// The classes of the groups that they are in and their own, outermost first.
    pub(crate) classes: Vec<String>,
    /// `data-polygon` and `data-edge`.
    pub(crate) edge: Option<[usize; 2]>,
    /// `data-polygon` and `data-crosses`.
    pub(crate) crossing: Option<[usize; 2]>,
    pub(crate) data: String,
}

/// A filled path of a drawing.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct DrawnPath {
    /// `data-polygon`.
    pub(crate) polygon: Option<usize>,
    /// Its own attribute, or the attribute of the groups around it.
    pub(crate) fill: [u8; 3],
    pub(crate) material: Option<String>,
}

/// A file that is valid XML.
pub(crate) struct Svg {
    pub(crate) text: String,
    pub(crate) paths: Vec<DrawnPath>,
    pub(crate) lines: Vec<DrawnLines>,
}

impl Svg {
    pub(crate) fn read(path: &Path) -> Self {
        Self::parse(&fs::read_to_string(path).unwrap())
    }

    pub(crate) fn parse(text: &str) -> Self {
        let document = Document::parse(text).unwrap_or_else(|error| panic!("{error}: {text}"));
        let root = document.root_element();
        assert_eq!(root.tag_name().namespace(), Some("http://www.w3.org/2000/svg"));
        let all = root.descendants().filter(|node| node.has_tag_name("path"));
        let (lines, filled): (Vec<_>, Vec<_>) =
            all.partition(|node| inherited(node, "fill") == Some("none"));
        let paths = filled.into_iter().map(drawn).collect();
        let lines = lines.into_iter().map(drawn_lines).collect();
        Self { paths, lines, text: text.to_owned() }
    }

    /// A viewer's picture, one sample per pixel at its centre.
    pub(crate) fn picture(&self) -> Picture {
        self.rendered(ShapeRendering::CrispEdges)
    }

    /// A viewer's picture, with edges blended.
    pub(crate) fn smooth_picture(&self) -> Picture {
        self.rendered(ShapeRendering::GeometricPrecision)
    }

    /// The red of each pixel, as the mean of this many pixels each way of a larger picture.
    pub(crate) fn averaged(&self, each: u32) -> Vec<f64> {
        let tree = Tree::from_str(&self.text, &Options::default()).unwrap();
        let size = tree.size().to_int_size();
        let mut pixels = Pixmap::new(size.width() * each, size.height() * each).unwrap();
        let scale = Transform::from_scale(each as f32, each as f32);
        resvg::render(&tree, scale, &mut pixels.as_mut());
        let (width, each) = (size.width() as usize, each as usize);
        let mut sums = vec![0.0; width * size.height() as usize];
        for (i, rgba) in pixels.data().chunks_exact(4).enumerate() {
            let (x, y) = (i % (width * each) / each, i / (width * each) / each);
            sums[y * width + x] += f64::from(rgba[0]) / (each * each) as f64;
        }
        sums
    }

    fn rendered(&self, shape_rendering: ShapeRendering) -> Picture {
        let options = Options { shape_rendering, ..Options::default() };
        let tree = Tree::from_str(&self.text, &options).unwrap();
        let size = tree.size().to_int_size();
        let mut pixels = Pixmap::new(size.width(), size.height()).unwrap();
        resvg::render(&tree, Transform::identity(), &mut pixels.as_mut());
        let rgb = pixels.data().chunks_exact(4).flat_map(|rgba| {
            assert_eq!(rgba[3], 255, "the background is opaque");
            [rgba[0], rgba[1], rgba[2]]
        });
        Picture { size: [size.width(), size.height()], rgb: rgb.collect() }
    }
}

/// An attribute of a node or of the nearest enclosing group that has it.
fn inherited<'d>(node: &Node<'d, '_>, name: &str) -> Option<&'d str> {
    node.ancestors().find_map(|node| node.attribute(name))
}

fn number(node: &Node<'_, '_>, name: &str) -> Option<usize> {
    node.attribute(name).map(|number| number.parse().unwrap())
}

fn drawn(node: Node<'_, '_>) -> DrawnPath {
    let fill = inherited(&node, "fill").unwrap();
    let channel = |at: usize| u8::from_str_radix(&fill[at..at + 2], 16).unwrap();
    DrawnPath {
        polygon: number(&node, "data-polygon"),
        fill: [1, 3, 5].map(channel),
        material: inherited(&node, "data-material").map(str::to_owned),
    }
}

fn drawn_lines(node: Node<'_, '_>) -> DrawnLines {
    let mut classes: Vec<String> =
        node.ancestors().filter_map(|node| node.attribute("class")).map(str::to_owned).collect();
    classes.reverse();
    let pair = |name: &str| {
        let pair = number(&node, "data-polygon").zip(number(&node, name));
        pair.map(|(polygon, other)| [polygon, other])
    };
    let (edge, crossing) = (pair("data-edge"), pair("data-crosses"));
    DrawnLines { classes, edge, crossing, data: node.attribute("d").unwrap().to_owned() }
}
