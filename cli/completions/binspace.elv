
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
            cand --threads 'Number of threads [default: one for each processor]'
            cand --quiet 'Print only errors: neither notes nor progress'
            cand --notes 'Print each note in full, in a line of its own'
            cand -h 'Print help (see more with ''--help'')'
            cand --help 'Print help (see more with ''--help'')'
            cand -V 'Print version'
            cand --version 'Print version'
            cand demo 'Draw built-in scenes, and compare every pixel with a depth buffer'
            cand order 'Write a scene''s fragments in paint order, one JSON object a line'
            cand verify 'Paint a scene in order and compare every pixel with a depth buffer'
            cand stats 'Build trees of a scene and print their figures'
            cand render 'Draw a scene as pixels: a PNG'
            cand draw 'Draw a view as vectors: SVG, PDF, TikZ or DXF, one path a visible polygon, or lines'
            cand page 'Write a self-contained page in which people turn the scene, for a browser'
            cand export 'Write a tree''s fragments as triangles, for other programs'
            cand build 'Build a scene''s tree and write it to a file that every command takes as a scene'
            cand scenes 'List the built-in scenes'
            cand generate 'Write completions of shells and manual pages into DIR'
            cand help 'Print this message or the help of the given subcommand(s)'
        }
        &'binspace;demo'= {
            cand -o 'Folder to write the pictures into; created if it does not exist'
            cand --output 'Folder to write the pictures into; created if it does not exist'
            cand --views 'Views of each scene to compare, around it and inside it'
            cand --size 'Size of the pictures in pixels'
            cand --seed 'Seed of the random views'
            cand --threads 'Number of threads [default: one for each processor]'
            cand --quiet 'Print only errors: neither notes nor progress'
            cand --notes 'Print each note in full, in a line of its own'
            cand -h 'Print help (see more with ''--help'')'
            cand --help 'Print help (see more with ''--help'')'
        }
        &'binspace;order'= {
            cand --seed 'Seed of random built-in scenes and of random views'
            cand --eye 'Position of the eye; repeat it for one order for each eye'
            cand --direction 'Direction of view, from infinitely far away'
            cand --cull 'Sides of polygons to leave out: none or back'
            cand -o 'File to write [default: standard output, as for -]'
            cand --output 'File to write [default: standard output, as for -]'
            cand --heuristic 'How to choose the planes; `binspace stats -h` lists the ways'
            cand --tolerance 'Distance within which points lie on a plane [default: by the input''s digits]'
            cand --max-fragments 'Largest number of fragments'
            cand --threads 'Number of threads [default: one for each processor]'
            cand --front-to-back 'List the nearest fragment first'
            cand --edges 'Add for each edge the number of the polygon''s edge that it lies on'
            cand --weights 'Add for each vertex the corners that it lies between, with weights'
            cand --quiet 'Print only errors: neither notes nor progress'
            cand --notes 'Print each note in full, in a line of its own'
            cand -h 'Print help (see more with ''--help'')'
            cand --help 'Print help (see more with ''--help'')'
        }
        &'binspace;verify'= {
            cand --seed 'Seed of random built-in scenes and of random views'
            cand --views 'Views to compare, alternately around the scene and inside it'
            cand --size 'Size of the pictures in pixels'
            cand --up 'Direction that points up: auto, x, y, z, -x or X,Y,Z'
            cand --cull 'Sides of polygons to leave out: none or back'
            cand --heuristic 'How to choose the planes; `binspace stats -h` lists the ways'
            cand --tolerance 'Distance within which points lie on a plane [default: by the input''s digits]'
            cand --max-fragments 'Largest number of fragments'
            cand --threads 'Number of threads [default: one for each processor]'
            cand --json 'Print a JSON object for each view and for the total'
            cand --quiet 'Print only errors: neither notes nor progress'
            cand --notes 'Print each note in full, in a line of its own'
            cand -h 'Print help (see more with ''--help'')'
            cand --help 'Print help (see more with ''--help'')'
        }
        &'binspace;stats'= {
            cand --seed 'Seed of random built-in scenes and of random views'
            cand --heuristic 'Heuristic to choose the planes: one of those below, or all'
            cand --tolerance 'Distance within which points lie on a plane [default: by the input''s digits]'
            cand --max-fragments 'Largest number of fragments'
            cand --threads 'Number of threads [default: one for each processor]'
            cand --json 'Print a JSON object for each tree'
            cand --quiet 'Print only errors: neither notes nor progress'
            cand --notes 'Print each note in full, in a line of its own'
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
            cand --target 'Point in the middle of the picture [default: the scene''s middle]'
            cand --up 'Direction that points up: auto, x, y, z, -x or X,Y,Z'
            cand --fov 'Vertical field of view in degrees'
            cand --size 'Size of the picture in pixels'
            cand --margin 'Empty share of the picture on each side of a whole scene, in percent'
            cand --colours 'Colours by material or polygon'
            cand --cull 'Sides of polygons to leave out: none or back'
            cand --samples 'Samples each way in a pixel: with more than 1, edges are smooth'
            cand --depth 'Draw depths: bright is near or, with --depth=far, far'
            cand --heuristic 'How to choose the planes; `binspace stats -h` lists the ways'
            cand --tolerance 'Distance within which points lie on a plane [default: by the input''s digits]'
            cand --max-fragments 'Largest number of fragments'
            cand --threads 'Number of threads [default: one for each processor]'
            cand --z-buffer 'Draw the picture of a depth buffer'
            cand --difference 'Draw where painter and depth buffer differ; exit status 1 if they do'
            cand --quiet 'Print only errors: neither notes nor progress'
            cand --notes 'Print each note in full, in a line of its own'
            cand -h 'Print help (see more with ''--help'')'
            cand --help 'Print help (see more with ''--help'')'
        }
        &'binspace;draw'= {
            cand --seed 'Seed of random built-in scenes and of random views'
            cand -o 'File to write: .svg, .pdf, .tex, .dxf or .png; - for standard output'
            cand --output 'File to write: .svg, .pdf, .tex, .dxf or .png; - for standard output'
            cand --format 'Format to write [default: by the file''s name; svg for standard output]'
            cand --eye 'Position of the eye'
            cand --direction 'Direction of view of a parallel projection'
            cand --view 'Parallel view by name: front, top, right or iso'
            cand --target 'Point in the middle of the picture [default: the scene''s middle]'
            cand --up 'Direction that points up: auto, x, y, z, -x or X,Y,Z'
            cand --fov 'Vertical field of view in degrees'
            cand --size 'Size of the picture in pixels'
            cand --margin 'Empty share of the picture on each side of a whole scene, in percent'
            cand --scale 'Millimetres of paper for each unit of the scene, with --view or --direction'
            cand --edges 'Edges to draw: none, all, creases[=DEG] or silhouettes [default: none; creases with --lines, --hidden or a DXF]'
            cand --hidden 'Hidden parts of edges: none, dashed or layers (by depth)'
            cand --line-width 'Width of lines in pixels'
            cand --colours 'Colours by material or polygon'
            cand --cull 'Sides of polygons to leave out: none or back'
            cand --background 'Colour behind the scene, such as #ffeecc, or none'
            cand --seams 'How to avoid light seams between neighbours'
            cand --min-size 'Leave out polygons of less than PX x PX pixels and shorter lines [default: 0.01; 0 in PNG]'
            cand --heuristic 'How to choose the planes; `binspace stats -h` lists the ways'
            cand --tolerance 'Distance within which points lie on a plane [default: by the input''s digits]'
            cand --max-fragments 'Largest number of fragments'
            cand --threads 'Number of threads [default: one for each processor]'
            cand --ids 'Write the numbers of polygons and edges and the names of materials into the SVG'
            cand --json 'Print the figures of the drawing as one JSON object'
            cand --lines 'Draw lines alone; polygons still hide lines behind them'
            cand --opaque 'Draw translucent polygons as opaque ones'
            cand --translucent 'Draw hidden polygons too, below those that hide them'
            cand --quiet 'Print only errors: neither notes nor progress'
            cand --notes 'Print each note in full, in a line of its own'
            cand -h 'Print help (see more with ''--help'')'
            cand --help 'Print help (see more with ''--help'')'
        }
        &'binspace;page'= {
            cand --seed 'Seed of random built-in scenes and of random views'
            cand -o 'File to write, such as scene.html; - for standard output'
            cand --output 'File to write, such as scene.html; - for standard output'
            cand --up 'Direction that points up: auto, x, y, z, -x or X,Y,Z'
            cand --cull 'Sides of polygons to leave out: none or back'
            cand --heuristic 'How to choose the planes; `binspace stats -h` lists the ways'
            cand --tolerance 'Distance within which points lie on a plane [default: by the input''s digits]'
            cand --max-fragments 'Largest number of fragments'
            cand --threads 'Number of threads [default: one for each processor]'
            cand --quiet 'Print only errors: neither notes nor progress'
            cand --notes 'Print each note in full, in a line of its own'
            cand -h 'Print help (see more with ''--help'')'
            cand --help 'Print help (see more with ''--help'')'
        }
        &'binspace;export'= {
            cand --seed 'Seed of random built-in scenes and of random views'
            cand -o 'File to write: .obj (and .mtl), .ply or .glb; - for standard output'
            cand --output 'File to write: .obj (and .mtl), .ply or .glb; - for standard output'
            cand --format 'Format of the file [default: by its name; obj for standard output]'
            cand --order 'Sort the triangles back to front for this eye'
            cand --heuristic 'How to choose the planes; `binspace stats -h` lists the ways'
            cand --tolerance 'Distance within which points lie on a plane [default: by the input''s digits]'
            cand --max-fragments 'Largest number of fragments'
            cand --threads 'Number of threads [default: one for each processor]'
            cand --unwelded 'Leave out the vertices that keep closed bodies closed'
            cand --quiet 'Print only errors: neither notes nor progress'
            cand --notes 'Print each note in full, in a line of its own'
            cand -h 'Print help (see more with ''--help'')'
            cand --help 'Print help (see more with ''--help'')'
        }
        &'binspace;build'= {
            cand --seed 'Seed of random built-in scenes and of random views'
            cand -o 'File to write, such as scene.bsp, or - for standard output; with --cells, a new folder'
            cand --output 'File to write, such as scene.bsp, or - for standard output; with --cells, a new folder'
            cand --cells 'Divide a scene too large for memory into N cells, for order, stats and render'
            cand --heuristic 'How to choose the planes; `binspace stats -h` lists the ways'
            cand --tolerance 'Distance within which points lie on a plane [default: by the input''s digits]'
            cand --max-fragments 'Largest number of fragments'
            cand --threads 'Number of threads [default: one for each processor]'
            cand --quiet 'Print only errors: neither notes nor progress'
            cand --notes 'Print each note in full, in a line of its own'
            cand -h 'Print help (see more with ''--help'')'
            cand --help 'Print help (see more with ''--help'')'
        }
        &'binspace;scenes'= {
            cand --threads 'Number of threads [default: one for each processor]'
            cand --quiet 'Print only errors: neither notes nor progress'
            cand --notes 'Print each note in full, in a line of its own'
            cand -h 'Print help (see more with ''--help'')'
            cand --help 'Print help (see more with ''--help'')'
        }
        &'binspace;generate'= {
            cand --threads 'Number of threads [default: one for each processor]'
            cand --quiet 'Print only errors: neither notes nor progress'
            cand --notes 'Print each note in full, in a line of its own'
            cand -h 'Print help (see more with ''--help'')'
            cand --help 'Print help (see more with ''--help'')'
        }
        &'binspace;help'= {
            cand demo 'Draw built-in scenes, and compare every pixel with a depth buffer'
            cand order 'Write a scene''s fragments in paint order, one JSON object a line'
            cand verify 'Paint a scene in order and compare every pixel with a depth buffer'
            cand stats 'Build trees of a scene and print their figures'
            cand render 'Draw a scene as pixels: a PNG'
            cand draw 'Draw a view as vectors: SVG, PDF, TikZ or DXF, one path a visible polygon, or lines'
            cand page 'Write a self-contained page in which people turn the scene, for a browser'
            cand export 'Write a tree''s fragments as triangles, for other programs'
            cand build 'Build a scene''s tree and write it to a file that every command takes as a scene'
            cand scenes 'List the built-in scenes'
            cand generate 'Write completions of shells and manual pages into DIR'
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
