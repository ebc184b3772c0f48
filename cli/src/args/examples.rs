//! Examples at the end of each help text.

pub(crate) const PROGRAM: &str = "\
Examples:
  binspace demo                              the built-in scenes, judged; pictures in out/
  binspace order scene.obj --eye=0,2,10      fragments in paint order, as JSON lines
  binspace render scene.obj -o scene.png     a picture of the whole scene
  binspace draw part.obj -o part.pdf --lines its visible edges, as a PDF
  binspace page scene.obj -o scene.html      a page to turn it in a browser

Every command also takes --threads N, --quiet, and --notes for each note in full.
Exit status: 0 success; 1 an image differs from the depth buffer's; 2 an error: bad usage
or input, output that cannot be written, too little memory.";

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

Heuristics, by the plane that divides a set of polygons:
  first          the plane of the first polygon (Fuchs, Kedem and Naylor 1980)
  random:SEED    the plane of a random polygon (Paterson and Yao 1990)
  fewest-splits  the plane of a polygon that cuts the fewest (Fuchs, Abram and Grant 1983)
  balanced       the plane of a polygon with the most equal sides (Naylor 1993: rarely good)
  weighted:SPLITS,BALANCE,AXIAL
                 the plane of the lowest weighted sum of both (Thibault and Naylor 1987)
  sampled:K      the same plane, among those of K polygons (Fuchs, Abram and Grant 1983)
  free-planes    a plane across an axis, as in a k-d tree (Bentley 1975), by bins (Wald 2007)
  auto           a free plane or a polygon's, by one cost; polygons are compared
                 by successive halving (Karnin, Koren and Somekh 2013)";

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
