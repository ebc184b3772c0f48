//! Examples at the end of each help text.

pub(crate) const PROGRAM: &str = "\
Examples:
  binspace demo                              the built-in scenes, judged; pictures in out/
  binspace order scene.obj --eye=0,2,10      fragments in paint order, as JSON lines
  binspace verify teapot --views 20          every pixel against a depth buffer
  binspace stats city:100000 --heuristic all how the heuristics compare
  binspace render scene.obj -o scene.png     a picture of the whole scene
  binspace draw scene.obj -o scene.svg       a drawing of it, one path a polygon
  binspace draw part.obj -o part.pdf --lines its visible edges
  binspace page scene.obj -o scene.html      a page to turn it in a browser
  binspace export scene.obj -o scene.glb     its fragments for other programs
  binspace build scene.obj -o scene.bsp      a tree to be used again, in place of the scene
  binspace build big.obj --cells 16 -o big   a scene larger than memory, cell by cell

Exit status: 0 done; 1 an image differs from the depth buffer's; 2 an error: bad usage
or input, output that cannot be written, too little memory.";

pub(crate) const DEMO: &str = "\
Examples:
  binspace demo
  binspace demo --views 2 --size 320x240 -o pictures";

pub(crate) const BUILD: &str = "\
Examples:
  binspace build scene.obj -o scene.bsp
  binspace order scene.bsp --eye=0,2,10
  binspace build city:100000 -o - | binspace render - -o city.png
  binspace build big.obj --cells 16 -o big && binspace render big -o big.png";

pub(crate) const ORDER: &str = "\
Examples:
  binspace order scene.obj --eye=0,2,10
  binspace order scene.obj --direction 0,0,-1 --front-to-back -o order.jsonl
  binspace order scene.obj --eye=0,2,10 --eye=5,2,0 --edges --weights
  gunzip -c scene.obj.gz | binspace order - --eye=0,2,10 --cull back
  binspace order teapot:16 --eye=9,-4,3 | head -1";

pub(crate) const VERIFY: &str = "\
Examples:
  binspace verify scene.obj
  binspace verify random:2000 --seed 7 --views 20 --size 1920x1080
  binspace verify layers --tolerance 0 --heuristic fewest-splits";

pub(crate) const STATS: &str = "\
Examples:
  binspace stats scene.obj
  binspace stats terrain:100000 --heuristic all --json

Heuristics, by the plane that divides a set of polygons:
  first          of the first polygon (Fuchs, Kedem and Naylor 1980)
  random(SEED)   of a random polygon (Paterson and Yao 1990)
  fewest-splits  of the polygon whose plane cuts the fewest (Fuchs, Abram and Grant 1983)
  balanced       of the polygon that leaves both sides most equal (Naylor 1993: rarely good)
  weighted(SPLITS,BALANCE,AXIAL)
                 of the lowest weighted sum of both (Thibault and Naylor 1987)
  sampled(K)     the same, among K polygons (Fuchs, Abram and Grant 1983)
  free-planes    across an axis, as in a k-d tree (Bentley 1975), by bins (Wald 2007)
  auto           of the last kind or a polygon's, by one cost; polygons are compared
                 by successive halving (Karnin, Koren and Somekh 2013)";

pub(crate) const RENDER: &str = "\
Examples:
  binspace render teapot -o teapot.png
  binspace render scene.obj -o scene.svg --up z --size 1200x900
  binspace render scene.obj -o smooth.png --samples 4
  binspace render room.obj -o room.png --cull back
  binspace render cornell -o inside.png --eye=278,273,100 --target=278,200,559 --fov 70
  binspace render city:5000 -o map.svg --direction=1,1,-1
  binspace render scene.obj -o difference.png --difference
  binspace render - -o - --format svg < scene.obj > scene.svg";

pub(crate) const DRAW: &str = "\
Examples:
  binspace draw teapot -o teapot.svg
  binspace draw scene.obj -o scene.pdf --up z --size 1200x900
  binspace draw scene.obj -o smooth.png
  binspace draw glass.obj -o glass.svg --translucent
  binspace draw part.obj -o part.svg --lines --hidden dashed
  binspace draw part.obj -o part.pdf --edges creases=20
  binspace draw mesh.obj -o plot.svg --lines --edges silhouettes
  binspace draw city:5000 -o map.svg --direction=1,1,-1 --colours polygon
  binspace draw room.obj -o room.svg --cull back --ids
  binspace draw scene.obj -o scene.svg --min-size 0.5 --json
  binspace draw - -o - < scene.obj | gzip > scene.svgz";

pub(crate) const EXPORT: &str = "\
Examples:
  binspace export scene.obj -o scene.ply
  binspace export glass.glb -o sorted.glb --order=9,-4,3
  binspace export random:200 -o - --format ply > pieces.ply";

pub(crate) const PAGE: &str = "\
Examples:
  binspace page teapot -o teapot.html
  binspace page rooms.obj -o rooms.html --up z --cull back
  binspace page random:500 -o random.html --heuristic fewest-splits
  binspace page scene.bsp -o - > scene.html";
