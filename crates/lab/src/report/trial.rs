//! A scene with views and the true picture of each view: the reference for every method.

use std::panic::resume_unwind;
use std::thread;
use std::time::{Duration, Instant};

use binspace::Error;
use binspace::glam::DVec3;
use binspace::internals::{Faces, SplitMix64};
use binspace::raster::{Image, Rays, zbuffer};
use binspace::scene::Scene;
use binspace::view::Camera;
use binspace_evidence::Family;
use binspace_evidence::measure::{PictureError, area_error, extent};
use binspace_evidence::method::{Method, MethodError, Prepared};

use super::figures::{Figures, Row};
use binspace_cli::camera;
use binspace_cli::failure::Failure;
use binspace_cli::job;

/// Builds and paints that take less time than this are repeated, to reduce the effect of clock steps and cold
/// caches.
const LONG_ENOUGH: Duration = Duration::from_millis(5);
/// The most repetitions.
const REPEATS: usize = 5;

/// A scene, and the true picture of each view of it.
pub(super) struct Trial {
    faces: Faces,
    views: Vec<View>,
}

struct View {
    camera: Camera,
    rays: Rays,
    truth: Image,
}

impl Trial {
    /// A step of a family's sweep, with the family's tolerance.
    pub(super) fn of_family(
        family: Family,
        difficulty: f64,
        seed: u64,
        size: [u32; 2],
    ) -> Result<Self, Failure> {
        let scene = family.scene(difficulty, seed);
        let cameras = family.cameras(difficulty, seed, size);
        Self::new(&scene, Some(Family::TOLERANCE), cameras)
    }

    /// Any scene, with the default tolerance.
    pub(super) fn of_scene(
        scene: &Scene,
        views: usize,
        seed: u64,
        size: [u32; 2],
    ) -> Result<Self, Failure> {
        Self::new(scene, None, around_and_inside(scene, views, seed, size))
    }

    fn new(
        scene: &Scene,
        tolerance: Option<f64>,
        cameras: Result<Vec<Camera>, Error>,
    ) -> Result<Self, Failure> {
        let (faces, preparation) =
            Faces::new(scene.polygons(), tolerance).map_err(|error| job::about(scene, &error))?;
        if tolerance.is_none() {
            job::note_preparation(scene, &faces, &preparation);
        }
        let view = |camera: Camera| {
            let rays = Rays::new(&camera, &faces)?;
            let truth = zbuffer(&rays, &faces).into_image();
            Ok(View { camera, rays, truth })
        };
        let views = cameras.and_then(|cameras| cameras.into_iter().map(view).collect());
        Ok(Self { views: views.map_err(|error| camera::about(scene, &error))?, faces })
    }

    /// A row for each method.
    pub(super) fn measure(&self, methods: &[Box<dyn Method>], difficulty: Option<f64>) -> Vec<Row> {
        let row = |method: &dyn Method| Row {
            difficulty,
            faces: self.faces.len(),
            views: self.views.len(),
            method: method.name(),
            space: method.space(),
            found: self.figures(method).map_err(|error| error.to_string()),
        };
        methods.iter().map(|method| row(&**method)).collect()
    }

    fn figures(&self, method: &dyn Method) -> Result<Figures, MethodError> {
        let (mut prepared, build) = repeat(|| {
            let start = Instant::now();
            method.prepare(&self.faces).map(|prepared| (prepared, start.elapsed()))
        })?;
        let (mut images, mut orders, mut draws) = (Vec::new(), Vec::new(), Vec::new());
        let (mut pieces, mut removed) = (0, 0);
        for view in &self.views {
            let painted = paint(&mut *prepared, view)?;
            orders.push(painted.order);
            draws.push(painted.draw);
            pieces = pieces.max(painted.pieces);
            removed += painted.removed;
            images.push(painted.image);
        }
        // Judges start only now, so that no other work runs while a method is timed.
        let (picture, (accuracy, area)) = self.judge(&images, || {
            let area = area_error(&self.faces, |visit| prepared.for_each_piece(visit));
            (prepared.accuracy(), area)
        });
        let extent = extent(&self.faces);
        let unit = self.faces.lattice().length_to_world(1.0);
        Ok(Figures {
            picture,
            accuracy,
            area,
            removed: removed as f64 / (self.views.len() * self.faces.len()).max(1) as f64,
            grid: if extent > 0.0 { unit / extent } else { 0.0 },
            pieces,
            build: build.as_secs_f64(),
            order: median(orders),
            draw: median(draws),
            bytes: prepared.bytes(),
        })
    }

    /// Judges a picture of each view on separate threads while this thread does other work.
    fn judge<T>(&self, images: &[Image], meanwhile: impl FnOnce() -> T) -> (PictureError, T) {
        let error = &|(view, image): (&View, &Image)| {
            PictureError::of(&view.rays, &self.faces, image, &view.truth)
        };
        thread::scope(|scope| {
            let start =
                |pair| (pair, thread::Builder::new().spawn_scoped(scope, move || error(pair)));
            let started: Vec<_> = self.views.iter().zip(images).map(start).collect();
            let other = meanwhile();
            let mut sum = PictureError::default();
            for (pair, thread) in started {
                sum += match thread {
                    Ok(thread) => thread.join().unwrap_or_else(|panic| resume_unwind(panic)),
                    // If no thread can be started, this thread does it.
                    Err(_) => error(pair),
                };
            }
            (sum, other)
        })
    }
}

/// Paints a view, several times if it is short, and keeps the fastest time.
fn paint(
    prepared: &mut dyn Prepared,
    view: &View,
) -> Result<binspace_evidence::method::Painted, MethodError> {
    let (painted, _) = repeat(|| {
        let painted = prepared.paint(&view.camera, &view.rays)?;
        let time = painted.order + painted.draw;
        Ok::<_, MethodError>((painted, time))
    })?;
    Ok(painted)
}

/// Repeats a short function and returns the fastest run.
fn repeat<T, E>(mut once: impl FnMut() -> Result<(T, Duration), E>) -> Result<(T, Duration), E> {
    let start = Instant::now();
    let mut best = once()?;
    for _ in 1..REPEATS {
        if start.elapsed() >= LONG_ENOUGH {
            break;
        }
        let next = once()?;
        if next.1 < best.1 {
            best = next;
        }
    }
    Ok(best)
}

fn median(mut times: Vec<Duration>) -> f64 {
    times.sort();
    times.get(times.len() / 2).map_or(0.0, Duration::as_secs_f64)
}

/// Creates cameras alternately around a scene and inside it. The arithmetic here is the same to the last bit
/// on every machine; the sine and cosine in [`binspace::view::views`] are not.
fn around_and_inside(
    scene: &Scene,
    count: usize,
    seed: u64,
    size: [u32; 2],
) -> Result<Vec<Camera>, Error> {
    let (low, high) = scene.bounds().unwrap_or_default();
    let (centre, half) = (low * 0.5 + high * 0.5, high * 0.5 - low * 0.5);
    let reach = half.max_element();
    let mut random = SplitMix64::new(seed);
    let eye_and_target = |i: usize| {
        let (first, second) = (random.point(-0.8, 0.8), random.point(-0.8, 0.8));
        if i.is_multiple_of(2) {
            let away = (first + DVec3::new(0.01, 0.02, 0.03)).normalize();
            (centre + away * (3.2 * reach), centre + second * half * 0.2)
        } else {
            (centre + first * half, centre + second * half)
        }
    };
    let pairs: Vec<(DVec3, DVec3)> = (0..count).map(eye_and_target).collect();
    let camera = |(eye, target)| {
        let slope = 0.45;
        Camera::perspective_by_slope(eye, target, scene.up(), slope, size)
            .or_else(|_| Camera::perspective_by_slope(eye, target, DVec3::ONE, slope, size))
    };
    pairs.into_iter().map(camera).collect()
}
