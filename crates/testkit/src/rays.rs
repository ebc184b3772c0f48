//! Checks that an order paints far before near: compares rays with fragments, in big integers.
//!
//! The fragments that a ray hits, and the places of the hits, are computed for every fragment from the lines
//! of its source face, without the tree.

use super::dice::Dice;
use super::judge::{Verdict, ensure};
use super::vector::{self, difference, product, scalar};
use super::views::View;
use binspace::BspTree;
use binspace::glam::DVec3;
use binspace::internals::{Faces, PlaneId, PlaneKind};
use dashu_int::IBig;
use num_traits::{Signed, Zero};
use std::cmp::Ordering;
use std::collections::HashMap;
use std::ops::Range;

pub type Vector = vector::Vector<IBig>;

/// If a ray has more hits than this, only neighbours in the order are compared. If all neighbours are right,
/// all pairs are right, except pairs that the tolerance excuses.
const MANY: usize = 48;

type Plane = vector::Plane<IBig>;

fn named_plane(faces: &Faces, id: PlaneId) -> Plane {
    match id.kind() {
        PlaneKind::Face(face) => {
            let [p, q, r] = faces.reference_triangle(face).map(|c| vector(faces.corner(c)));
            Plane::through([&p, &q, &r])
        }
        PlaneKind::Axis(axis, corner) => Plane::new(unit(axis), &vector(faces.corner(corner))),
    }
}

fn unit(axis: usize) -> Vector {
    std::array::from_fn(|i| IBig::from(u8::from(i == axis)))
}

fn length(plane: &Plane) -> f64 {
    let float = |c: &IBig| c.to_f64().value();
    DVec3::from_array(plane.normal.each_ref().map(float)).length()
}

/// A plane at a ray: its value at the origin, and its change along the ray.
pub struct AtRay {
    start: IBig,
    slope: IBig,
}

/// A ray from a point, or, with `endless`, the whole line.
pub struct Ray {
    origin: Vector,
    direction: Vector,
    endless: bool,
}

impl Ray {
    /// Creates the line of sight through a point in lattice units, unless the eye is there.
    pub fn through(target: DVec3, view: &View) -> Option<Self> {
        let (origin, direction) = view.ray_to(target);
        let is_ray = !direction.iter().all(Zero::is_zero);
        is_ray.then(|| Self { origin, direction, endless: view.is_parallel() })
    }

    /// Returns the rounded place of a hit, and the start of the ray, if the ray has a start.
    pub fn places(&self, hit: &Hit) -> (DVec3, Option<DVec3>) {
        let float = |v: &Vector| DVec3::from_array(v.each_ref().map(|c| c.to_f64().value()));
        let at = |i: usize| {
            let sum = &self.origin[i] * &hit.face.slope - &self.direction[i] * &hit.face.start;
            (sum / &hit.face.slope).to_f64().value()
        };
        (DVec3::new(at(0), at(1), at(2)), (!self.endless).then(|| float(&self.origin)))
    }

    fn plane(&self, plane: &Plane) -> AtRay {
        let start = scalar(&plane.normal, &self.origin) - &plane.offset;
        AtRay { start, slope: scalar(&plane.normal, &self.direction) }
    }
}

/// The point where a ray passes through a fragment. Its parameter is −start/slope of the plane of the
/// fragment's face, with a slope above 0.
pub struct Hit {
    pub fragment: u32,
    face: AtRay,
}

impl Hit {
    pub fn depth_order(&self, other: &Self) -> Ordering {
        (-&self.face.start * &other.face.slope).cmp(&(-&other.face.start * &self.face.slope))
    }

    /// A plane at the hit, times the (positive) slope.
    fn value(&self, plane: &AtRay) -> IBig {
        &plane.start * &self.face.slope - &plane.slope * &self.face.start
    }
}

/// The number of the plane of a fragment's face. Then the number of each plane that bounds the fragment, with
/// the sign inside.
type Outline = (usize, Vec<(usize, Ordering)>);

/// A tree's fragments, each bounded by planes.
pub struct Rays<'t> {
    tree: &'t BspTree,
    planes: Vec<Plane>,
    fragments: Vec<Outline>,
    /// The number of compared pairs of hits.
    pub pairs: usize,
    /// The number of pairs that only the tolerance excuses.
    pub contested: usize,
}

impl<'t> Rays<'t> {
    pub fn new(tree: &'t BspTree) -> Self {
        let faces = tree.faces();
        let mut planes = Vec::new();
        let mut named: HashMap<PlaneId, usize> = HashMap::new();
        let mut edges: HashMap<(u32, u32), (usize, Ordering)> = HashMap::new();
        let mut fragments = Vec::new();
        for fragment in tree.fragments() {
            let face = fragment.face();
            let mut name = |planes: &mut Vec<Plane>, id| {
                *named.entry(id).or_insert_with(|| {
                    planes.push(named_plane(faces, id));
                    planes.len() - 1
                })
            };
            let own = name(&mut planes, PlaneId::face(face));
            let bounds = fragment.lines().map(|line| match (line.as_edge(), line.as_cut()) {
                (_, Some(plane)) => {
                    let sign = if line.is_behind() { Ordering::Less } else { Ordering::Greater };
                    (name(&mut planes, plane), sign)
                }
                (edge, None) => {
                    let edge = edge.expect("an edge or a cut");
                    *edges.entry((face, edge)).or_insert_with(|| {
                        let (plane, sign) = upright(faces, face, edge as usize, &planes[own]);
                        planes.push(plane);
                        (planes.len() - 1, sign)
                    })
                }
            });
            fragments.push((own, bounds.collect()));
        }
        Self { tree, planes, fragments, pairs: 0, contested: 0 }
    }

    /// Shoots rays from a viewpoint at points of fragments, and compares their hits with the order.
    pub fn check(&mut self, view: &View, rays: usize, dice: &mut Dice) -> Verdict {
        let mut order = Vec::new();
        self.tree.back_to_front_into(view.viewpoint, &mut order);
        let mut place = vec![usize::MAX; order.len()];
        order.iter().enumerate().for_each(|(at, &id)| place[id as usize] = at);
        for _ in 0..rays {
            let target = self.some_point(dice);
            let Some(ray) = Ray::through(target, view) else { continue };
            let mut hits = self.hits(&ray);
            let reach = if hits.len() > MANY { 1 } else { hits.len() };
            hits.sort_by_key(|hit| place[hit.fragment as usize]);
            for (i, a) in hits.iter().enumerate() {
                for b in hits[i + 1..].iter().take(reach) {
                    self.compare(&ray, a, b, &place).map_err(|what| format!("{what}, {view:?}"))?;
                }
            }
        }
        Ok(())
    }

    /// Returns a point inside a fragment, rounded, in lattice units.
    pub fn some_point(&self, dice: &mut Dice) -> DVec3 {
        let fragment = self.tree.fragment(dice.below(self.tree.len()) as u32);
        let (mut sum, mut total) = (DVec3::ZERO, 0.0);
        for vertex in fragment.lattice_vertices() {
            let weight = 0.05 + dice.share();
            sum += DVec3::from(vertex) * weight;
            total += weight;
        }
        sum / total
    }

    /// Returns the hits of a ray inside the outlines of fragments.
    pub fn hits(&self, ray: &Ray) -> Vec<Hit> {
        let at: Vec<AtRay> = self.planes.iter().map(|plane| ray.plane(plane)).collect();
        let hit = |(id, (own, bounds)): (usize, &Outline)| {
            let own = &at[*own];
            let turn = |value: &IBig| if own.slope.is_negative() { -value } else { value.clone() };
            let face = AtRay { start: turn(&own.start), slope: turn(&own.slope) };
            if face.slope.is_zero() || (!ray.endless && !face.start.is_negative()) {
                return None;
            }
            let hit = Hit { fragment: id as u32, face };
            bounds.iter().all(|&(p, sign)| vector::sign(&hit.value(&at[p])) == sign).then_some(hit)
        };
        self.fragments.iter().enumerate().filter_map(hit).collect()
    }

    /// Compares two hits of a ray with the places of their fragments in an order.
    pub fn compare(&mut self, ray: &Ray, a: &Hit, b: &Hit, place: &[usize]) -> Verdict {
        self.pairs += 1;
        let [p, q] = [a, b].map(|hit| place[hit.fragment as usize]);
        let depth = a.depth_order(b);
        if depth.is_ne() && depth == q.cmp(&p) {
            return Ok(());
        }
        let [face, other] = [a, b].map(|hit| self.tree.fragment(hit.fragment).face());
        let in_input_order = face.cmp(&other) == p.cmp(&q);
        let wrong = || format!("fragments {} and {} come out wrong", a.fragment, b.fragment);
        if self.tree.faces().tolerance() == 0.0 {
            let touch = depth.is_eq() && self.is_same_plane(a, b);
            return ensure(touch && in_input_order, wrong);
        }
        self.contested += 1;
        self.excuse(ray, [a, b], in_input_order).then_some(()).ok_or_else(wrong)
    }

    fn is_same_plane(&self, a: &Hit, b: &Hit) -> bool {
        let [g, h] = [a, b].map(|hit| &self.planes[self.fragments[hit.fragment as usize].0]);
        product(&g.normal, &h.normal).iter().all(Zero::is_zero)
    }

    /// Whether the tolerance excuses the order of two hits. Both hits, or the nearer hit and the eye, must be
    /// within the tolerance of the plane that separates the two fragments. If both fragments lie on this
    /// plane, they must come in input order.
    fn excuse(&self, ray: &Ray, hits: [&Hit; 2], in_input_order: bool) -> bool {
        let ids = hits.map(|hit| hit.fragment);
        let count = |range: &Range<u32>| ids.iter().filter(|id| range.contains(id)).count();
        let parting = self.tree.nodes().find(|node| {
            let [on, front, back] = [&node.on(), &node.in_front(), &node.behind()].map(count);
            on + front + back == 2 && front < 2 && back < 2
        });
        let Some(parting) = parting else { return false };
        let plane = named_plane(self.tree.faces(), parting.plane());
        let reach = self.tree.faces().tolerance() * (1.0 + 1e-9) * length(&plane);
        let at = ray.plane(&plane);
        let float = |value: &IBig| value.abs().to_f64().value();
        let is_near = |hit: &&Hit| float(&hit.value(&at)) <= reach * float(&hit.face.slope);
        let near = hits.iter().filter(|hit| is_near(hit)).count();
        let nearer = hits.into_iter().min_by(|a, b| a.depth_order(b));
        let eye_is_near = !ray.endless && float(&at.start) <= reach;
        let excused = near == 2 || nearer.as_ref().is_some_and(is_near) && eye_is_near;
        excused && (in_input_order || count(&parting.on()) < 2)
    }
}

/// The plane through an edge of a face, parallel to the axis along which the face's plane is least steep; and
/// the sign of this plane inside the face.
fn upright(faces: &Faces, face: u32, edge: usize, plane: &Plane) -> (Plane, Ordering) {
    let corners = faces.corners(face);
    let [a, b] = [edge, (edge + 1) % corners.len()].map(|k| vector(corners[k]));
    let axis = vector::main_axis(&plane.normal);
    // The axis, the edge and the direction inwards are a right-handed frame.
    (Plane::new(product(&unit(axis), &difference(&b, &a)), &a), vector::sign(&plane.normal[axis]))
}

pub fn vector(p: [f64; 3]) -> Vector {
    p.map(|c| IBig::from(c as i128))
}
