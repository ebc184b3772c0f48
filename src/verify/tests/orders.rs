//! Orders with faults of every kind.

use super::cameras;
use crate::raster::Rays;
use crate::scene::{self, Scene};
use crate::tree::BspTree;
use crate::verify::{Orders, Verification, judge};
use crate::view::Camera;

const FORMS: usize = 4;

/// The list that is painted front to back.
const PAINTED_NEAR_FIRST: usize = 2;

fn case() -> (Scene, BspTree) {
    let scene = scene::random_triangles(60, 1);
    let tree = BspTree::build(scene.polygons()).unwrap();
    (scene, tree)
}

fn orders(tree: &BspTree, camera: &Camera) -> Orders {
    Orders::of(tree, camera.viewpoint())
}

/// The judgement of orders, one form of which is not the tree's order.
fn judged(
    tree: &BspTree,
    camera: &Camera,
    form: usize,
    spoil: impl FnOnce(&mut Vec<u32>),
) -> Verification {
    let mut orders = orders(tree, camera);
    spoil(&mut orders.0[form]);
    let judgement = judge(tree, Rays::new(camera, tree.faces()).unwrap(), orders);
    assert!(!judgement.is_right() && judgement.orders.is_err());
    judgement
}

fn fault(judgement: &Verification) -> String {
    judgement.orders.as_ref().unwrap_err().to_string()
}

#[test]
fn a_form_that_contradicts_the_others_is_named() {
    let (scene, tree) = case();
    let camera = &cameras(&scene, 1)[0];
    assert_eq!(orders(&tree, camera).check(tree.len()), Ok(()));
    let names = ["order", "front_to_back", "front_to_back().write_into"];
    for (form, name) in (1..FORMS).zip(names) {
        for place in [0, tree.len() / 2, tree.len() - 2] {
            let judgement = judged(&tree, camera, form, |list| list.swap(place, place + 1));
            let expected = format!("{name} contradicts write_into at place {place} of");
            assert!(fault(&judgement).starts_with(&expected), "{}", fault(&judgement));
        }
    }
    // Errors name the other forms, because the other forms are compared with the list.
    let judgement = judged(&tree, camera, 0, |list| list.swap(0, 1));
    assert!(fault(&judgement).starts_with("order contradicts"));
}

#[test]
fn fragments_listed_twice_or_never_or_from_nowhere_are_named() {
    let (scene, tree) = case();
    let camera = &cameras(&scene, 1)[0];
    for form in 0..FORMS {
        let fault = |spoil: fn(&mut Vec<u32>)| fault(&judged(&tree, camera, form, spoil));
        let doubled = fault(|list| list.insert(8, list[7]));
        assert!(doubled.contains("more than once"), "{doubled}");
        let missing = fault(|list| {
            list.remove(7);
        });
        assert!(missing.contains("leaves out fragment"), "{missing}");
        let unknown = fault(|list| list[7] = list.len() as u32);
        assert!(unknown.contains("which does not exist"), "{unknown}");
        assert!(fault(Vec::clear).contains("leaves out fragment 0"));
    }
}

/// The opaque picture is the same, but a transparent picture would differ.
#[test]
fn a_fragment_painted_twice_in_its_place_is_counted() {
    let (scene, tree) = case();
    for camera in &cameras(&scene, 4) {
        let mut found = 0;
        for place in 0..tree.len() {
            let judgement = judged(&tree, camera, 0, |list| list.insert(place + 1, list[place]));
            assert_eq!(judgement.comparison.wrong(), 0);
            found += usize::from(judgement.miscounted > 0);
        }
        assert!(found > 20, "only {found} fragments seen");
    }
}

#[test]
fn a_fragment_that_is_left_out_is_counted_though_others_hide_it() {
    let (scene, tree) = case();
    let camera = &cameras(&scene, 1)[0];
    let mut hidden = 0;
    for place in 0..tree.len() {
        let judgement = judged(&tree, camera, 0, |list| {
            list.remove(place);
        });
        let wrong = judgement.comparison.wrong();
        assert!(judgement.miscounted >= wrong);
        hidden += usize::from(wrong == 0 && judgement.miscounted > 0);
    }
    assert!(hidden > 5, "only {hidden} hidden fragments");
}

/// For one node after the other, exchanges its two subtrees in one order. Some of these faults are visible,
/// but only in the picture that is painted in that direction.
#[test]
fn a_flipped_side_shows_in_the_picture_of_its_direction() {
    let (scene, tree) = case();
    let camera = &cameras(&scene, 1)[0];
    let mut shown = [0, 0];
    for node in tree.nodes() {
        let (on, front, back) = (node.on(), node.in_front(), node.behind());
        if front.is_empty() || back.is_empty() {
            continue;
        }
        for (form, shown) in [0, PAINTED_NEAR_FIRST].into_iter().zip(&mut shown) {
            let judgement = judged(&tree, camera, form, |list| {
                let is_inside = |f: &u32| [&front, &on, &back].iter().any(|part| part.contains(f));
                let first = list.iter().position(is_inside).unwrap();
                let len = node.fragments().len();
                let part = &mut list[first..first + len];
                let far = if front.contains(&part[0]) { &front } else { &back };
                part.rotate_left(far.len());
                let near = len - far.len() - on.len();
                part[..on.len() + near].rotate_left(on.len());
            });
            let pictures = [&judgement.comparison, &judgement.front_to_back];
            let [wrong, right] = if form == 0 { pictures } else { [pictures[1], pictures[0]] };
            *shown += usize::from(wrong.wrong_order > 0);
            assert_eq!((right.wrong(), judgement.miscounted), (0, 0));
        }
    }
    assert!(shown[0] > 10 && shown[0] == shown[1], "{shown:?}");
}

/// Lists that agree with each other, but are wrong.
#[test]
fn wrong_orders_that_agree_cause_wrong_pixels() {
    let (scene, tree) = case();
    let camera = &cameras(&scene, 1)[0];
    let mut reversed = orders(&tree, camera);
    reversed.0.iter_mut().for_each(|list| list.reverse());
    let judgement = judge(&tree, Rays::new(camera, tree.faces()).unwrap(), reversed);
    assert_eq!(judgement.orders, Ok(()));
    assert!(judgement.comparison.wrong_order > 0 && !judgement.is_right());
    assert_eq!(judgement.comparison, judgement.front_to_back);
}
