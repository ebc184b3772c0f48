//! Examples at the end of each help text.

pub(crate) const PROGRAM: &str = "\
Examples:
  binspace demo                              compare pictures of built-in scenes; write out/
  binspace order scene.obj --eye=0,2,10      fragments in painting order, as JSON lines
  binspace render scene.obj -o scene.png     a picture of the whole scene
  binspace draw part.obj -o part.pdf --lines visible edges, as a PDF
  binspace page scene.obj -o scene.html      a page for a browser, in which the scene turns

Every command also accepts --threads N, --quiet (errors only) and --notes (notes in full).
Exit status: 0 success; 1 a picture differs from the depth buffer's; 2 an error in the usage
or the input, an output that cannot be written, or too little memory.";

pub(crate) const DEMO: &str = "\
Examples:
  binspace demo
  binspace demo --views 2 --size 320x240 -o pictures";

pub(crate) const BUILD: &str = "\
Examples:
  binspace build scene.obj -o scene.bsp
  binspace order scene.bsp --eye=0,2,10
  binspace build big.obj --cells 16 -o big && binspace render big -o big.png";

pub(crate) const ORDER: &str = "\
Examples:
  binspace order scene.obj --eye 0 2 10
  binspace order scene.obj --direction=0,0,-1 --front-to-back -o order.jsonl
  gunzip -c scene.obj.gz | binspace order - --eye=0,2,10 --eye=5,2,0 --cull back";

pub(crate) const VERIFY: &str = "\
Examples:
  binspace verify scene.obj
  binspace verify random:2000 --seed 7 --views 20 --size 1920x1080
  binspace verify layers --tolerance 0 --heuristic fewest-splits";

pub(crate) const STATS: &str = "\
Examples:
  binspace stats terrain:100000 --heuristic all --json
  binspace stats scene.obj --heuristic weighted:8,1,0

Heuristics. Each splits a set of polygons by
  first          the plane of the first polygon (Fuchs, Kedem and Naylor 1980)
  random:SEED    the plane of a random polygon (Paterson and Yao 1990)
  fewest-splits  the polygon's plane that splits the fewest polygons (Fuchs, Abram and Grant 1983)
  balanced       the polygon's plane with the most equal sides (Naylor 1993: rarely good)
  weighted:SPLITS,BALANCE,AXIAL
                 the polygon's plane of least cost: SPLITS for each split polygon, BALANCE for
                 each polygon more on one side; AXIAL per polygon is subtracted if the plane is
                 perpendicular to an axis (Thibault and Naylor 1987)
  sampled:K      the plane of least cost by weighted, of K polygons (Fuchs, Abram and Grant 1983)
  free-planes    a plane perpendicular to an axis, as in a k-d tree (Bentley 1975; Wald 2007)
  auto           a plane of either kind, with the least estimated work; polygons' planes are
                 compared by successive halving (Karnin, Koren and Somekh 2013)";

pub(crate) const RENDER: &str = "\
Examples:
  binspace render scene.obj -o scene.png --samples 4 --size 1200x900
  binspace render room.obj -o room.png --cull back
  binspace render cornell -o inside.png --eye 278 273 100 --target 278 200 559 --fov 70
  binspace render - -o - < scene.obj > scene.png";

pub(crate) const DRAW: &str = "\
Examples:
  binspace draw part.obj -o part.svg --lines --hidden dashed --view iso
  binspace draw plan.obj -o plan.pdf --view top --scale 10";

pub(crate) const EXPORT: &str = "\
Examples:
  binspace export scene.obj -o scene.ply
  binspace export glass.glb -o sorted.glb --order=9,-4,3
  binspace export random:200 -o - --format ply > pieces.ply";

pub(crate) const PAGE: &str = "\
Examples:
  binspace page teapot -o teapot.html
  binspace page rooms.obj -o rooms.html --up z --cull back";
