//! Compares trees with rays: fragments must come far before near, or in input order if they are in one plane,
//! and must cover every polygon once.

use super::cells::{Border, Cells};
use super::drawing::{Drawing, Within};
use super::exact::Plane;
use super::ray::{Hit, Ray, Targets};
use super::scene::world;
use super::view::{self, Place, View};
use crate::judge::{Verdict, ensure};
use crate::orders;
use crate::prelude::*;

/// The counts of comparisons.
#[derive(Clone, Copy, Debug, Default)]
pub struct Score {
    pub trees: usize,
    /// Trees that were given up because they would have more fragments than allowed.
    pub given_up: usize,
    pub faces: usize,
    pub fragments: usize,
    pub rays: usize,
    /// Pairs of polygons that a ray meets one behind the other, or in one plane.
    pub pairs: usize,
    /// The number of these pairs that are in one plane.
    pub coplanar: usize,
    /// Points on the border of a fragment, whose cells were computed in big integers; with a tolerance,
    /// these hits are left out.
    pub borders: usize,
    /// Pairs met on both borders by a ray that lies in the plane between them: either may come first.
    pub grazing: usize,
    /// Pairs in the wrong order within the tolerance.
    pub excused: usize,
}

impl Score {
    pub fn total(scores: &[(String, Self)]) -> Self {
        scores.iter().map(|(_, score)| *score).fold(Self::default(), Self::plus)
    }

    pub fn plus(mut self, other: Self) -> Self {
        self.trees += other.trees;
        self.given_up += other.given_up;
        self.faces += other.faces;
        self.fragments += other.fragments;
        self.rays += other.rays;
        self.pairs += other.pairs;
        self.coplanar += other.coplanar;
        self.borders += other.borders;
        self.grazing += other.grazing;
        self.excused += other.excused;
        self
    }
}

/// A viewpoint, and the hits of the rays from there: computed once for all trees of a scene.
pub struct Shot {
    view: View,
    rays: Vec<(Ray, Vec<Vec<Hit>>)>,
}

/// Rays from `views` viewpoints, of all kinds alternately.
pub fn shots(targets: &Targets<'_>, [views, rays]: [usize; 2], dice: &mut Dice) -> Vec<Shot> {
    let scene = targets.scene;
    // With a tolerance, rays along edges decide nothing.
    let generic = scene.tolerance > 0.0;
    let mut views_dice = Dice(dice.roll());
    let mut shot = |view: View, rays: usize| {
        let others = (0..rays).filter_map(|_| view.some_ray(scene, generic, dice));
        let rays = view.first_ray().into_iter().chain(others);
        let rays = rays.map(|ray| (ray.clone(), targets.hits(&ray))).collect();
        Shot { view, rays }
    };
    let mut shots = Vec::new();
    for kind in 0..views {
        let view = view::some_view(scene, kind, &mut views_dice);
        shots.push(shot(view, rays));
        shots.push(shot(view::in_line(scene, &mut views_dice), 1));
    }
    shots
}

/// A tree to be judged.
pub struct Court<'t> {
    targets: &'t Targets<'t>,
    tree: &'t BspTree,
    drawing: Drawing<'t>,
    cells: Cells,
    score: Score,
}

/// A hit, the fragment there, and whether the hit is on the fragment's border.
struct Found<'h> {
    hit: &'h Hit,
    fragment: u32,
    border: Border,
    place: u32,
}

impl<'t> Court<'t> {
    pub fn new(targets: &'t Targets<'t>, tree: &'t BspTree) -> Self {
        let drawing = Drawing::new(targets, tree);
        let cells = Cells::new(targets, tree);
        let score = Score {
            trees: 1,
            faces: tree.faces().len(),
            fragments: tree.len(),
            ..Score::default()
        };
        Self { targets, tree, drawing, cells, score }
    }

    /// Runs all checks.
    pub fn judge(mut self, shots: &[Shot]) -> Result<Score, String> {
        self.input_has_not_moved()?;
        self.drawing.check(self.tree)?;
        for shot in shots {
            let context = |what| format!("{what}, seen from {:?}", shot.view);
            self.shoot(shot).map_err(context)?;
        }
        Ok(self.score)
    }

    /// Checks the judge's assumption that faces are the polygons, with exactly the same corners.
    fn input_has_not_moved(&self) -> Verdict {
        let (scene, faces) = (self.targets.scene, self.tree.faces());
        ensure(faces.len() == scene.polygons.len(), || format!("{} faces", faces.len()))?;
        for (face, polygon) in scene.polygons.iter().enumerate() {
            let corners = faces.corners(face as u32);
            let same = corners.len() == polygon.len()
                && faces.polygon(face as u32) == face
                && corners
                    .iter()
                    .zip(polygon)
                    .all(|(&corner, &p)| faces.lattice().to_world(corner) == world(p));
            ensure(same, || format!("polygon {face} has moved: {polygon:?}"))?;
        }
        Ok(())
    }

    /// Checks that eyes are on the lattice to the last bit.
    fn eye_has_not_moved(&self, shot: &Shot) -> Verdict {
        let (Place::Eye(eye, below), Viewpoint::Eye(point)) =
            (&shot.view.place, shot.view.viewpoint())
        else {
            return Ok(());
        };
        let lattice = self.tree.faces().lattice();
        let corner = self.tree.faces().corner(0);
        let (there, here) = (lattice.to_lattice(point), lattice.to_world(corner));
        let steps = rational::exact(lattice.length_to_lattice(1.0));
        let exact = |x: f64| rational::exact(x);
        for axis in 0..3 {
            let eye = rational::Rational::from_parts_signed(eye[axis].into(), (*below).into());
            let moved = exact(there[axis]) - exact(corner[axis]);
            ensure(moved == (eye - exact(here[axis])) * &steps, || "the eye has moved".into())?;
        }
        Ok(())
    }

    fn shoot(&mut self, shot: &Shot) -> Verdict {
        self.eye_has_not_moved(shot)?;
        orders::check(self.tree, shot.view.viewpoint())?;
        let mut order = Vec::new();
        self.tree.back_to_front_into(shot.view.viewpoint(), &mut order);
        let mut places = vec![0; order.len()];
        order.iter().zip(0..).for_each(|(&id, place)| places[id as usize] = place);
        for (ray, groups) in &shot.rays {
            self.ray(ray, groups, &places).map_err(|what| format!("{what}, along {ray:?}"))?;
        }
        Ok(())
    }

    fn ray(&mut self, ray: &Ray, groups: &[Vec<Hit>], places: &[u32]) -> Verdict {
        self.score.rays += 1;
        let mut before: Vec<Found<'_>> = Vec::new();
        let (mut last, mut hits) = (None, 0);
        for group in groups {
            let mut found = Vec::new();
            for hit in group {
                found.extend(self.find(hit, places)?);
            }
            let place = |found: &Found<'_>| found.place;
            self.score.pairs += hits * group.len();
            hits += group.len();
            let is_nearer = last < found.iter().map(place).min() || found.is_empty();
            if !is_nearer || self.targets.scene.tolerance > 0.0 {
                for a in &before {
                    for b in &found {
                        self.compare(ray, a, b)?;
                    }
                }
            }
            for (i, a) in found.iter().enumerate() {
                for b in &found[i + 1..] {
                    self.compare_at_one_place(ray, a, b)?;
                }
            }
            last = last.max(found.iter().map(place).max());
            before.extend(found);
        }
        Ok(())
    }

    /// The fragments of a polygon at a hit: one fragment around the hit, or several that share a border
    /// there.
    fn find<'h>(&mut self, hit: &'h Hit, places: &[u32]) -> Result<Vec<Found<'h>>, String> {
        let found = |fragment: u32, border| Found {
            hit,
            fragment,
            border,
            place: places[fragment as usize],
        };
        let drawn = self.drawing.fragments_at(hit.polygon, hit.spot.rounded);
        let surely = drawn.iter().filter(|&&(_, within)| within == Within::Surely).count();
        ensure(surely <= 1, || format!("polygon {} is covered twice at {hit:?}", hit.polygon))?;
        if surely == 1 && drawn.len() == 1 {
            return Ok(vec![found(drawn[0].0, Border::Inside)]);
        }
        let hole = || format!("polygon {} has a hole at {hit:?}", hit.polygon);
        ensure(!drawn.is_empty(), hole)?;
        self.score.borders += 1;
        if self.targets.scene.tolerance > 0.0 {
            // With a tolerance, polygons may reach out of cells.
            return Ok(vec![]);
        }
        let mut all = Vec::new();
        for &(fragment, within) in &drawn {
            match self.cells.within(fragment, &hit.spot)? {
                Some(border) => all.push(found(fragment, border)),
                None => ensure(within == Within::Perhaps, || {
                    format!("fragment {fragment} is drawn outside its cell, at {hit:?}")
                })?,
            }
        }
        let inside = all.iter().filter(|found| found.border == Border::Inside).count();
        ensure(!all.is_empty(), hole)?;
        ensure(inside <= 1 && (inside == 0 || all.len() == 1), || {
            format!("polygon {} is covered twice at {hit:?}", hit.polygon)
        })?;
        Ok(all)
    }

    /// Compares two fragments with their places, the first further away.
    fn compare(&mut self, ray: &Ray, a: &Found<'_>, b: &Found<'_>) -> Verdict {
        if a.place < b.place {
            return Ok(());
        }
        let (far, near) = (a.hit.polygon, b.hit.polygon);
        let wrong =
            || format!("polygon {far} (fragment {}) hides {near} ({})", a.fragment, b.fragment);
        let between = self.tree.plane_between(a.fragment, b.fragment).ok_or_else(wrong)?;
        let between = self.targets.named(self.tree, between);
        if self.targets.scene.tolerance == 0.0 {
            let borders = [a, b].map(|found| found.border) == [Border::On; 2];
            self.score.grazing += 1;
            return ensure(borders && ray.is_in(&between), wrong);
        }
        self.excuse(ray, [a, b], &between)
    }

    /// Checks that the tolerance excuses a wrong order. Both parts, or the nearer part and the eye, must be
    /// within the tolerance of the plane between the parts. If both parts count as lying on this plane, they
    /// must be in input order.
    fn excuse(&mut self, ray: &Ray, [a, b]: [&Found<'_>; 2], between: &Plane) -> Verdict {
        self.score.excused += 1;
        let tolerance = self.targets.scene.tolerance * (1.0 + 1e-9);
        let in_input_order = a.hit.polygon.cmp(&b.hit.polygon) == a.place.cmp(&b.place);
        ensure(in_input_order || !self.cells.share_a_plane(a.fragment, b.fragment), || {
            format!("fragments {} and {}, on one plane, are out of order", a.fragment, b.fragment)
        })?;
        let is_near = |found: &Found<'_>| between.distance(&found.hit.spot).abs() <= tolerance;
        let eye = ray.start_from(between).is_some_and(|from| from.abs() <= tolerance);
        ensure(is_near(b) && (is_near(a) || eye), || {
            let (far, near) = (a.hit.polygon, b.hit.polygon);
            format!("polygon {far} hides {near}, further off than the tolerance")
        })
    }

    /// Checks the order of two polygons that a ray meets at the same point: input order, if they are in one
    /// plane.
    fn compare_at_one_place(&mut self, ray: &Ray, a: &Found<'_>, b: &Found<'_>) -> Verdict {
        let (p, q) = (a.hit.polygon, b.hit.polygon);
        let planes = [p, q].map(|polygon| &self.targets.planes[polygon]);
        if p == q || !planes[0].is_same_as(planes[1]) {
            return Ok(());
        }
        self.score.pairs += 1;
        self.score.coplanar += 1;
        // Where only borders meet, both polygons are visible, each on its side.
        let apart = a.border == Border::On && b.border == Border::On;
        if apart || p.cmp(&q) == a.place.cmp(&b.place) {
            return Ok(());
        }
        let wrong = || format!("polygons {p} and {q}, in one plane, are out of order");
        ensure(self.targets.scene.tolerance > 0.0, wrong)?;
        let between = self.tree.plane_between(a.fragment, b.fragment).ok_or_else(wrong)?;
        self.excuse(ray, [a, b], &self.targets.named(self.tree, between))
    }
}
