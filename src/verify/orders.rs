//! Compares the forms in which a tree returns an order with each other.

use std::fmt;
use std::ops::ControlFlow;

use crate::paint::Pieces;
use crate::raster::{Comparison, Image, Rays, compare_by, covers, is_open};
use crate::tree::{BspTree, Fragment};
use crate::viewpoint::Viewpoint;

/// The forms in which a tree returns an order: back to front, then front to back.
const FORMS: [&str; 6] = [
    "back_to_front_into",
    "back_to_front",
    "visit_back_to_front",
    "front_to_back",
    "front_to_back_into",
    "visit_front_to_back",
];
const FAR_FIRST: usize = 3;

/// What is wrong with an order; see [`check_orders`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OrderFault {
    form: &'static str,
    kind: Kind,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Kind {
    Unknown { fragment: u32 },
    Repeated { fragment: u32 },
    Missing { fragment: u32 },
    Differs { place: usize },
}

impl fmt::Display for OrderFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let form = self.form;
        match self.kind {
            Kind::Unknown { fragment } => {
                write!(f, "{form} lists fragment {fragment}, which does not exist")
            }
            Kind::Repeated { fragment } => {
                write!(f, "{form} lists fragment {fragment} more than once")
            }
            Kind::Missing { fragment } => write!(f, "{form} leaves out fragment {fragment}"),
            Kind::Differs { place } => {
                write!(f, "{form} contradicts {} at place {place} of the order", FORMS[0])
            }
        }
    }
}

impl std::error::Error for OrderFault {}

/// Checks that the orders of a viewpoint list every fragment once, are the same as a list of
/// numbers, by iterator and by visitor, and that front to back is the reverse of back to front.
///
/// This compares the orders only with each other; [`verify`](crate::verify::verify) also compares their
/// pictures with a depth buffer's.
///
/// # Errors
///
/// The first fault found, if there is one.
pub fn check_orders(tree: &BspTree, viewpoint: Viewpoint) -> Result<(), OrderFault> {
    Orders::of(tree, viewpoint).check(tree.len())
}

/// The orders of one viewpoint, a list of fragments for each of [`FORMS`].
#[derive(Clone, Debug)]
pub(super) struct Orders(pub(super) [Vec<u32>; 6]);

impl Orders {
    /// The orders of a tree. An order that does not end is cut off once it is certainly too long.
    pub(super) fn of(tree: &BspTree, viewpoint: Viewpoint) -> Self {
        let most = tree.len() + 1;
        let (mut far_first, mut near_first) = (Vec::new(), Vec::new());
        tree.back_to_front_into(viewpoint, &mut far_first);
        tree.front_to_back_into(viewpoint, &mut near_first);
        let number = |fragment: Fragment<'_>| fragment.index();
        let (mut visited, mut visited_near) = (Vec::new(), Vec::new());
        let _ = tree.visit_back_to_front(viewpoint, |f| note(&mut visited, f.index(), most));
        let _ = tree.visit_front_to_back(viewpoint, |f| note(&mut visited_near, f.index(), most));
        Self([
            far_first,
            tree.back_to_front(viewpoint).map(number).take(most).collect(),
            visited,
            tree.front_to_back(viewpoint).map(number).take(most).collect(),
            near_first,
            visited_near,
        ])
    }

    /// The list form, back to front.
    pub(super) fn back_to_front(&self) -> &[u32] {
        &self.0[0]
    }

    /// The iterator form, front to back.
    pub(super) fn front_to_back(&self) -> &[u32] {
        &self.0[FAR_FIRST]
    }

    /// Checks that each form lists each of `fragments` fragments once, and that all forms agree.
    pub(super) fn check(&self, fragments: usize) -> Result<(), OrderFault> {
        for (form, list) in FORMS.into_iter().zip(&self.0) {
            each_once(list, fragments).map_err(|kind| OrderFault { form, kind })?;
        }
        let expected = &self.0[0];
        for (i, (form, list)) in FORMS.into_iter().zip(&self.0).enumerate() {
            let differs = |place: &usize| {
                let at = if i < FAR_FIRST { *place } else { fragments - 1 - *place };
                list[*place] != expected[at]
            };
            if let Some(place) = (0..fragments).find(differs) {
                return Err(OrderFault { form, kind: Kind::Differs { place } });
            }
        }
        Ok(())
    }
}

/// Adds a fragment to a list; breaks off once the list is too long.
fn note(list: &mut Vec<u32>, fragment: u32, most: usize) -> ControlFlow<()> {
    list.push(fragment);
    if list.len() < most { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
}

fn each_once(list: &[u32], fragments: usize) -> Result<(), Kind> {
    let mut seen = vec![false; fragments];
    for &fragment in list {
        match seen.get_mut(fragment as usize) {
            None => return Err(Kind::Unknown { fragment }),
            Some(true) => return Err(Kind::Repeated { fragment }),
            Some(seen) => *seen = true,
        }
    }
    match seen.iter().position(|seen| !seen) {
        Some(fragment) => Err(Kind::Missing { fragment: fragment as u32 }),
        None => Ok(()),
    }
}

/// Compares a painted picture of a tree with a true one. Contested are ties, and pixels in which the
/// tolerance, at the plane between the two fragments, leaves open which of them is painted last.
pub(super) fn compare_by_planes(
    tree: &BspTree,
    rays: &Rays,
    painted: &Image,
    truth: &Image,
) -> Comparison {
    let faces = tree.faces();
    if faces.tolerance() == 0.0 {
        return compare_by(rays, faces, [painted, truth], 0.0, |_, _| false);
    }
    let mut sorted = None;
    let mut pieces = Pieces::default();
    // The fragment of a face that covers a pixel.
    let mut fragment_at = |face: u32, pixel| {
        let by_face: &Vec<(u32, u32)> = sorted.get_or_insert_with(|| {
            let mut by_face: Vec<_> = tree.fragments().map(|f| (f.face(), f.index())).collect();
            by_face.sort_unstable();
            by_face
        });
        let first = by_face.partition_point(|&(other, _)| other < face);
        let of_face = by_face[first..].iter().take_while(|&&(other, _)| other == face);
        let mut fragments = of_face.map(|&(_, fragment)| fragment);
        fragments.find(|&fragment| {
            let piece = pieces.of(&tree.fragment(fragment));
            covers(rays, faces, piece, pixel)
        })
    };
    compare_by(rays, faces, [painted, truth], 0.0, |met, pixel| {
        let [nearest, other] = met.map(|face| fragment_at(face, pixel));
        let parting = nearest.zip(other).and_then(|(a, b)| tree.parting(a, b));
        parting.is_some_and(|(plane, [near, far])| {
            is_open(rays, faces, plane, [(met[0], near), (met[1], far)], pixel)
        })
    })
}
