
use builtin;
use str;

set edit:completion:arg-completer[binspace] = {|@words|
    fn spaces {|n|
        builtin:repeat $n ' ' | str:join ''
    }
    fn cand {|text desc|
        edit:complex-candidate $text &display=$text' '(spaces (- 14 (wcswidth $text)))$desc
    }
    var command = 'binspace'
    for word $words[1..-1] {
        if (str:has-prefix $word '-') {
            break
        }
        set command = $command';'$word
    }
    var completions = [
        &'binspace'= {
            cand --threads 'Number of threads [default: one per processor]'
            cand --quiet 'Print errors only: no notes, no progress'
            cand --notes 'Print each note in full, on its own line'
            cand -h 'Print help (see more with ''--help'')'
            cand --help 'Print help (see more with ''--help'')'
            cand -V 'Print version'
            cand --version 'Print version'
            cand demo 'Draw built-in scenes and compare every pixel with a depth buffer'
            cand order 'Write a scene''s fragments in painting order, one JSON object per line'
            cand verify 'Paint a scene in order and compare every pixel with a depth buffer'
            cand stats 'Build trees of a scene and print their sizes and times'
            cand render 'Draw a scene as pixels, in a PNG'
            cand draw 'Draw a scene as vectors (SVG, PDF, TikZ, DXF): one path per visible polygon, or lines'
            cand page 'Write a page for a browser, in which readers turn the scene'
            cand export 'Write a tree''s fragments as triangles, for other programs'
            cand build 'Build a scene''s tree and store both in a file that every command accepts as SCENE'
            cand scenes 'List the built-in scenes'
            cand generate 'Write shell completions and manual pages into DIR'
            cand help 'Print this message or the help of the given subcommand(s)'
        }
        &'binspace;demo'= {
            cand -o 'Folder for the pictures; created if it is missing'
            cand --output 'Folder for the pictures; created if it is missing'
            cand --views 'Number of views to compare, around each scene and inside it'
            cand --size 'Size of the pictures in pixels'
            cand --seed 'Seed of random scenes and views'
            cand --threads 'Number of threads [default: one per processor]'
            cand --quiet 'Print errors only: no notes, no progress'
            cand --notes 'Print each note in full, on its own line'
            cand -h 'Print help (see more with ''--help'')'
            cand --help 'Print help (see more with ''--help'')'
        }
        &'binspace;order'= {
            cand --seed 'Seed of random built-in scenes and of random views'
            cand --eye 'Position of the eye; repeat the option for more eyes'
            cand --direction 'Direction of view, for an eye infinitely far away'
            cand --cull 'Sides of polygons to omit: none or back'
            cand -o 'File to write; - for standard output'
            cand --output 'File to write; - for standard output'
            cand --heuristic 'Heuristic to choose splitting planes: see `binspace stats -h`'
            cand --tolerance 'Points this close to a plane lie on it [default: by the input''s precision]'
            cand --max-fragments 'Stop with an error if the tree needs more fragments'
            cand --threads 'Number of threads [default: one per processor]'
            cand --front-to-back 'List the nearest fragment first'
            cand --edges 'Add the number of the polygon''s edge on which each edge lies'
            cand --weights 'Add weights of the polygon''s corners for each vertex, to interpolate attributes'
            cand --quiet 'Print errors only: no notes, no progress'
            cand --notes 'Print each note in full, on its own line'
            cand -h 'Print help (see more with ''--help'')'
            cand --help 'Print help (see more with ''--help'')'
        }
        &'binspace;verify'= {
            cand --seed 'Seed of random built-in scenes and of random views'
            cand --views 'Number of views to compare, alternately around the scene and inside it'
            cand --size 'Size of the pictures in pixels'
            cand --up 'Direction that points up: auto, x, y, z, -x or X,Y,Z'
            cand --cull 'Sides of polygons to omit: none or back'
            cand --heuristic 'Heuristic to choose splitting planes: see `binspace stats -h`'
            cand --tolerance 'Points this close to a plane lie on it [default: by the input''s precision]'
            cand --max-fragments 'Stop with an error if the tree needs more fragments'
            cand --threads 'Number of threads [default: one per processor]'
            cand --json 'Print a JSON object for each view and one for the total'
            cand --quiet 'Print errors only: no notes, no progress'
            cand --notes 'Print each note in full, on its own line'
            cand -h 'Print help (see more with ''--help'')'
            cand --help 'Print help (see more with ''--help'')'
        }
        &'binspace;stats'= {
            cand --seed 'Seed of random built-in scenes and of random views'
            cand --heuristic 'Heuristic to choose splitting planes: a name from below, or all'
            cand --tolerance 'Points this close to a plane lie on it [default: by the input''s precision]'
            cand --max-fragments 'Stop with an error if the tree needs more fragments'
            cand --threads 'Number of threads [default: one per processor]'
            cand --json 'Print a JSON object for each tree'
            cand --quiet 'Print errors only: no notes, no progress'
            cand --notes 'Print each note in full, on its own line'
            cand -h 'Print help (see more with ''--help'')'
            cand --help 'Print help (see more with ''--help'')'
        }
        &'binspace;render'= {
            cand --seed 'Seed of random built-in scenes and of random views'
            cand -o 'PNG file to write; - for standard output'
            cand --output 'PNG file to write; - for standard output'
            cand --eye 'Position of the eye'
            cand --direction 'Direction of view of a parallel projection'
            cand --view 'Parallel view by name: front, top, right or iso'
            cand --target 'Point at the centre of the picture [default: the scene''s centre]'
            cand --up 'Direction that points up: auto, x, y, z, -x or X,Y,Z'
            cand --fov 'Vertical field of view in degrees'
            cand --size 'Size of the picture in pixels'
            cand --margin 'Empty border around a whole scene, in percent of the picture on each side'
            cand --colours 'Colour by material or by polygon'
            cand --cull 'Sides of polygons to omit: none or back'
            cand --samples 'Antialias: N x N samples per pixel'
            cand --depth 'Draw depths: near is bright; with --depth=far, far is bright'
            cand --heuristic 'Heuristic to choose splitting planes: see `binspace stats -h`'
            cand --tolerance 'Points this close to a plane lie on it [default: by the input''s precision]'
            cand --max-fragments 'Stop with an error if the tree needs more fragments'
            cand --threads 'Number of threads [default: one per processor]'
            cand --z-buffer 'Draw with a depth buffer'
            cand --difference 'Draw where painter and depth buffer differ; exit status 1 if they do'
            cand --quiet 'Print errors only: no notes, no progress'
            cand --notes 'Print each note in full, on its own line'
            cand -h 'Print help (see more with ''--help'')'
            cand --help 'Print help (see more with ''--help'')'
        }
        &'binspace;draw'= {
            cand --seed 'Seed of random built-in scenes and of random views'
            cand -o 'File to write: .svg, .pdf, .tex, .dxf or .png; - for standard output'
            cand --output 'File to write: .svg, .pdf, .tex, .dxf or .png; - for standard output'
            cand --format 'File format [default: by the file''s name; svg for standard output]'
            cand --eye 'Position of the eye'
            cand --direction 'Direction of view of a parallel projection'
            cand --view 'Parallel view by name: front, top, right or iso'
            cand --target 'Point at the centre of the picture [default: the scene''s centre]'
            cand --up 'Direction that points up: auto, x, y, z, -x or X,Y,Z'
            cand --fov 'Vertical field of view in degrees'
            cand --size 'Size of the picture in pixels'
            cand --margin 'Empty border around a whole scene, in percent of the picture on each side'
            cand --scale 'Millimetres of paper per unit of the scene; needs --view or --direction'
            cand --edges 'Edges to draw: none, all, creases[=DEG] or silhouettes [default: none; creases with --lines, --hidden or a DXF]'
            cand --hidden 'Hidden edges: none, dashed or layers (dashed by depth)'
            cand --line-width 'Width of lines in pixels'
            cand --colours 'Colour by material or by polygon'
            cand --cull 'Sides of polygons to omit: none or back'
            cand --background 'Colour behind the scene, such as #ffeecc, or none'
            cand --seams 'How to avoid light seams between adjacent polygons'
            cand --min-size 'Omit polygons with less visible area than PX x PX pixels, and lines shorter than PX [default: 0.01; 0 in a PNG]'
            cand --heuristic 'Heuristic to choose splitting planes: see `binspace stats -h`'
            cand --tolerance 'Points this close to a plane lie on it [default: by the input''s precision]'
            cand --max-fragments 'Stop with an error if the tree needs more fragments'
            cand --threads 'Number of threads [default: one per processor]'
            cand --ids 'Write polygon numbers, edge numbers and material names into the SVG'
            cand --json 'Print statistics of the drawing as a JSON object'
            cand --lines 'Draw only lines; polygons still hide the lines behind them'
            cand --opaque 'Ignore opacities: draw all polygons as opaque'
            cand --translucent 'Draw hidden polygons too, under the polygons in front of them'
            cand --quiet 'Print errors only: no notes, no progress'
            cand --notes 'Print each note in full, on its own line'
            cand -h 'Print help (see more with ''--help'')'
            cand --help 'Print help (see more with ''--help'')'
        }
        &'binspace;page'= {
            cand --seed 'Seed of random built-in scenes and of random views'
            cand -o 'File to write, such as scene.html; - for standard output'
            cand --output 'File to write, such as scene.html; - for standard output'
            cand --up 'Direction that points up: auto, x, y, z, -x or X,Y,Z'
            cand --cull 'Sides of polygons to omit: none or back'
            cand --heuristic 'Heuristic to choose splitting planes: see `binspace stats -h`'
            cand --tolerance 'Points this close to a plane lie on it [default: by the input''s precision]'
            cand --max-fragments 'Stop with an error if the tree needs more fragments'
            cand --threads 'Number of threads [default: one per processor]'
            cand --quiet 'Print errors only: no notes, no progress'
            cand --notes 'Print each note in full, on its own line'
            cand -h 'Print help (see more with ''--help'')'
            cand --help 'Print help (see more with ''--help'')'
        }
        &'binspace;export'= {
            cand --seed 'Seed of random built-in scenes and of random views'
            cand -o 'File to write: .obj (and .mtl), .ply or .glb; - for standard output'
            cand --output 'File to write: .obj (and .mtl), .ply or .glb; - for standard output'
            cand --format 'File format [default: by the file''s name; obj for standard output]'
            cand --order 'Sort the triangles back to front for this eye'
            cand --heuristic 'Heuristic to choose splitting planes: see `binspace stats -h`'
            cand --tolerance 'Points this close to a plane lie on it [default: by the input''s precision]'
            cand --max-fragments 'Stop with an error if the tree needs more fragments'
            cand --threads 'Number of threads [default: one per processor]'
            cand --unwelded 'Leave T-junctions between fragments open: fewer triangles, but cracks'
            cand --quiet 'Print errors only: no notes, no progress'
            cand --notes 'Print each note in full, on its own line'
            cand -h 'Print help (see more with ''--help'')'
            cand --help 'Print help (see more with ''--help'')'
        }
        &'binspace;build'= {
            cand --seed 'Seed of random built-in scenes and of random views'
            cand -o 'File to write, such as scene.bsp; - for standard output; with --cells, a new folder'
            cand --output 'File to write, such as scene.bsp; - for standard output; with --cells, a new folder'
            cand --cells 'Divide a scene larger than memory into N cells; order, stats and render accept the folder'
            cand --heuristic 'Heuristic to choose splitting planes: see `binspace stats -h`'
            cand --tolerance 'Points this close to a plane lie on it [default: by the input''s precision]'
            cand --max-fragments 'Stop with an error if the tree needs more fragments'
            cand --threads 'Number of threads [default: one per processor]'
            cand --quiet 'Print errors only: no notes, no progress'
            cand --notes 'Print each note in full, on its own line'
            cand -h 'Print help (see more with ''--help'')'
            cand --help 'Print help (see more with ''--help'')'
        }
        &'binspace;scenes'= {
            cand --threads 'Number of threads [default: one per processor]'
            cand --quiet 'Print errors only: no notes, no progress'
            cand --notes 'Print each note in full, on its own line'
            cand -h 'Print help (see more with ''--help'')'
            cand --help 'Print help (see more with ''--help'')'
        }
        &'binspace;generate'= {
            cand --threads 'Number of threads [default: one per processor]'
            cand --quiet 'Print errors only: no notes, no progress'
            cand --notes 'Print each note in full, on its own line'
            cand -h 'Print help (see more with ''--help'')'
            cand --help 'Print help (see more with ''--help'')'
        }
        &'binspace;help'= {
            cand demo 'Draw built-in scenes and compare every pixel with a depth buffer'
            cand order 'Write a scene''s fragments in painting order, one JSON object per line'
            cand verify 'Paint a scene in order and compare every pixel with a depth buffer'
            cand stats 'Build trees of a scene and print their sizes and times'
            cand render 'Draw a scene as pixels, in a PNG'
            cand draw 'Draw a scene as vectors (SVG, PDF, TikZ, DXF): one path per visible polygon, or lines'
            cand page 'Write a page for a browser, in which readers turn the scene'
            cand export 'Write a tree''s fragments as triangles, for other programs'
            cand build 'Build a scene''s tree and store both in a file that every command accepts as SCENE'
            cand scenes 'List the built-in scenes'
            cand generate 'Write shell completions and manual pages into DIR'
            cand help 'Print this message or the help of the given subcommand(s)'
        }
        &'binspace;help;demo'= {
        }
        &'binspace;help;order'= {
        }
        &'binspace;help;verify'= {
        }
        &'binspace;help;stats'= {
        }
        &'binspace;help;render'= {
        }
        &'binspace;help;draw'= {
        }
        &'binspace;help;page'= {
        }
        &'binspace;help;export'= {
        }
        &'binspace;help;build'= {
        }
        &'binspace;help;scenes'= {
        }
        &'binspace;help;generate'= {
        }
        &'binspace;help;help'= {
        }
    ]
    $completions[$command]
}
