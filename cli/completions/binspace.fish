# Print an optspec for argparse to handle cmd's options that are independent of any subcommand.
function __fish_binspace_global_optspecs
    string join \n threads= quiet notes h/help V/version
end

function __fish_binspace_needs_command
    # Figure out if the current invocation already has a command.
    set -l cmd (commandline -opc)
    set -e cmd[1]
    argparse -s (__fish_binspace_global_optspecs) -- $cmd 2>/dev/null
    or return
    if set -q argv[1]
        # Also print the command, so this can be used to figure out what it is.
        echo $argv[1]
        return 1
    end
    return 0
end

function __fish_binspace_using_subcommand
    set -l cmd (__fish_binspace_needs_command)
    test -z "$cmd"
    and return 1
    contains -- $cmd[1] $argv
end

complete -c binspace -n "__fish_binspace_needs_command" -l threads -d 'Number of threads [default: one for each processor]' -r
complete -c binspace -n "__fish_binspace_needs_command" -l quiet -d 'Print only errors: neither notes nor progress'
complete -c binspace -n "__fish_binspace_needs_command" -l notes -d 'Print each note in full, in a line of its own'
complete -c binspace -n "__fish_binspace_needs_command" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c binspace -n "__fish_binspace_needs_command" -s V -l version -d 'Print version'
complete -c binspace -n "__fish_binspace_needs_command" -f -a "demo" -d 'Draw built-in scenes, and compare every pixel with a depth buffer'
complete -c binspace -n "__fish_binspace_needs_command" -f -a "order" -d 'Write a scene\'s fragments in paint order, one JSON object a line'
complete -c binspace -n "__fish_binspace_needs_command" -f -a "verify" -d 'Paint a scene in order and compare every pixel with a depth buffer'
complete -c binspace -n "__fish_binspace_needs_command" -f -a "stats" -d 'Build trees of a scene and print their figures'
complete -c binspace -n "__fish_binspace_needs_command" -f -a "render" -d 'Draw a scene as pixels: a PNG'
complete -c binspace -n "__fish_binspace_needs_command" -f -a "draw" -d 'Draw a view as vectors: SVG, PDF, TikZ or DXF, one path a visible polygon, or lines'
complete -c binspace -n "__fish_binspace_needs_command" -f -a "page" -d 'Write a self-contained page in which people turn the scene, for a browser'
complete -c binspace -n "__fish_binspace_needs_command" -f -a "export" -d 'Write a tree\'s fragments as triangles, for other programs'
complete -c binspace -n "__fish_binspace_needs_command" -f -a "build" -d 'Build a scene\'s tree and write it to a file that every command takes as a scene'
complete -c binspace -n "__fish_binspace_needs_command" -f -a "scenes" -d 'List the built-in scenes'
complete -c binspace -n "__fish_binspace_needs_command" -f -a "generate" -d 'Write completions of shells and manual pages into DIR'
complete -c binspace -n "__fish_binspace_needs_command" -f -a "help" -d 'Print this message or the help of the given subcommand(s)'
complete -c binspace -n "__fish_binspace_using_subcommand demo" -s o -l output -d 'Folder to write the pictures into; created if it does not exist' -r -F
complete -c binspace -n "__fish_binspace_using_subcommand demo" -l views -d 'Views of each scene to compare, around it and inside it' -r
complete -c binspace -n "__fish_binspace_using_subcommand demo" -l size -d 'Size of the pictures in pixels' -r
complete -c binspace -n "__fish_binspace_using_subcommand demo" -l seed -d 'Seed of the random views' -r
complete -c binspace -n "__fish_binspace_using_subcommand demo" -l threads -d 'Number of threads [default: one for each processor]' -r
complete -c binspace -n "__fish_binspace_using_subcommand demo" -l quiet -d 'Print only errors: neither notes nor progress'
complete -c binspace -n "__fish_binspace_using_subcommand demo" -l notes -d 'Print each note in full, in a line of its own'
complete -c binspace -n "__fish_binspace_using_subcommand demo" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c binspace -n "__fish_binspace_using_subcommand order" -l seed -d 'Seed of random built-in scenes and of random views' -r
complete -c binspace -n "__fish_binspace_using_subcommand order" -l eye -d 'Position of the eye; repeat it for one order for each eye' -r
complete -c binspace -n "__fish_binspace_using_subcommand order" -l direction -d 'Direction of view, from infinitely far away' -r
complete -c binspace -n "__fish_binspace_using_subcommand order" -l cull -d 'Sides of polygons to leave out: none or back' -r -f -a "none\t'Neither: polygons are seen from both sides'
back\t'Backs: polygons are seen only where their corners run counter-clockwise'"
complete -c binspace -n "__fish_binspace_using_subcommand order" -s o -l output -d 'File to write [default: standard output, as for -]' -r -F
complete -c binspace -n "__fish_binspace_using_subcommand order" -l heuristic -d 'How to choose the planes; `binspace stats -h` lists the ways' -r
complete -c binspace -n "__fish_binspace_using_subcommand order" -l tolerance -d 'Distance within which points lie on a plane [default: by the input\'s digits]' -r
complete -c binspace -n "__fish_binspace_using_subcommand order" -l max-fragments -d 'Largest number of fragments' -r
complete -c binspace -n "__fish_binspace_using_subcommand order" -l threads -d 'Number of threads [default: one for each processor]' -r
complete -c binspace -n "__fish_binspace_using_subcommand order" -l front-to-back -d 'List the nearest fragment first'
complete -c binspace -n "__fish_binspace_using_subcommand order" -l edges -d 'Add for each edge the number of the polygon\'s edge that it lies on'
complete -c binspace -n "__fish_binspace_using_subcommand order" -l weights -d 'Add for each vertex the corners that it lies between, with weights'
complete -c binspace -n "__fish_binspace_using_subcommand order" -l quiet -d 'Print only errors: neither notes nor progress'
complete -c binspace -n "__fish_binspace_using_subcommand order" -l notes -d 'Print each note in full, in a line of its own'
complete -c binspace -n "__fish_binspace_using_subcommand order" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c binspace -n "__fish_binspace_using_subcommand verify" -l seed -d 'Seed of random built-in scenes and of random views' -r
complete -c binspace -n "__fish_binspace_using_subcommand verify" -l views -d 'Views to compare, alternately around the scene and inside it' -r
complete -c binspace -n "__fish_binspace_using_subcommand verify" -l size -d 'Size of the pictures in pixels' -r
complete -c binspace -n "__fish_binspace_using_subcommand verify" -l up -d 'Direction that points up: auto, x, y, z, -x or X,Y,Z' -r
complete -c binspace -n "__fish_binspace_using_subcommand verify" -l cull -d 'Sides of polygons to leave out: none or back' -r -f -a "none\t'Neither: polygons are seen from both sides'
back\t'Backs: polygons are seen only where their corners run counter-clockwise'"
complete -c binspace -n "__fish_binspace_using_subcommand verify" -l heuristic -d 'How to choose the planes; `binspace stats -h` lists the ways' -r
complete -c binspace -n "__fish_binspace_using_subcommand verify" -l tolerance -d 'Distance within which points lie on a plane [default: by the input\'s digits]' -r
complete -c binspace -n "__fish_binspace_using_subcommand verify" -l max-fragments -d 'Largest number of fragments' -r
complete -c binspace -n "__fish_binspace_using_subcommand verify" -l threads -d 'Number of threads [default: one for each processor]' -r
complete -c binspace -n "__fish_binspace_using_subcommand verify" -l json -d 'Print a JSON object for each view and for the total'
complete -c binspace -n "__fish_binspace_using_subcommand verify" -l quiet -d 'Print only errors: neither notes nor progress'
complete -c binspace -n "__fish_binspace_using_subcommand verify" -l notes -d 'Print each note in full, in a line of its own'
complete -c binspace -n "__fish_binspace_using_subcommand verify" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c binspace -n "__fish_binspace_using_subcommand stats" -l seed -d 'Seed of random built-in scenes and of random views' -r
complete -c binspace -n "__fish_binspace_using_subcommand stats" -l heuristic -d 'Heuristic to choose the planes: one of those below, or all' -r
complete -c binspace -n "__fish_binspace_using_subcommand stats" -l tolerance -d 'Distance within which points lie on a plane [default: by the input\'s digits]' -r
complete -c binspace -n "__fish_binspace_using_subcommand stats" -l max-fragments -d 'Largest number of fragments' -r
complete -c binspace -n "__fish_binspace_using_subcommand stats" -l threads -d 'Number of threads [default: one for each processor]' -r
complete -c binspace -n "__fish_binspace_using_subcommand stats" -l json -d 'Print a JSON object for each tree'
complete -c binspace -n "__fish_binspace_using_subcommand stats" -l quiet -d 'Print only errors: neither notes nor progress'
complete -c binspace -n "__fish_binspace_using_subcommand stats" -l notes -d 'Print each note in full, in a line of its own'
complete -c binspace -n "__fish_binspace_using_subcommand stats" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c binspace -n "__fish_binspace_using_subcommand render" -l seed -d 'Seed of random built-in scenes and of random views' -r
complete -c binspace -n "__fish_binspace_using_subcommand render" -s o -l output -d 'PNG file to write; - for standard output' -r -F
complete -c binspace -n "__fish_binspace_using_subcommand render" -l eye -d 'Position of the eye' -r
complete -c binspace -n "__fish_binspace_using_subcommand render" -l direction -d 'Direction of view of a parallel projection' -r
complete -c binspace -n "__fish_binspace_using_subcommand render" -l view -d 'Parallel view by name: front, top, right or iso' -r -f -a "front\t'Horizontally: along y if z is up, against z if y is up'
top\t'From above'
right\t'Horizontally, from the right of the front view'
iso\t'Isometric: from the front, the right and above alike'"
complete -c binspace -n "__fish_binspace_using_subcommand render" -l target -d 'Point in the middle of the picture [default: the scene\'s middle]' -r
complete -c binspace -n "__fish_binspace_using_subcommand render" -l up -d 'Direction that points up: auto, x, y, z, -x or X,Y,Z' -r
complete -c binspace -n "__fish_binspace_using_subcommand render" -l fov -d 'Vertical field of view in degrees' -r
complete -c binspace -n "__fish_binspace_using_subcommand render" -l size -d 'Size of the picture in pixels' -r
complete -c binspace -n "__fish_binspace_using_subcommand render" -l margin -d 'Empty share of the picture on each side of a whole scene, in percent' -r
complete -c binspace -n "__fish_binspace_using_subcommand render" -l colours -d 'Colours by material or polygon' -r -f -a "material\t'From their materials; grey without one'
polygon\t'A different one for each polygon'"
complete -c binspace -n "__fish_binspace_using_subcommand render" -l cull -d 'Sides of polygons to leave out: none or back' -r -f -a "none\t'Neither: polygons are seen from both sides'
back\t'Backs: polygons are seen only where their corners run counter-clockwise'"
complete -c binspace -n "__fish_binspace_using_subcommand render" -l samples -d 'Samples each way in a pixel: with more than 1, edges are smooth' -r
complete -c binspace -n "__fish_binspace_using_subcommand render" -l depth -d 'Draw depths: bright is near or, with --depth=far, far' -r -f -a "near\t'The nearer, the brighter'
far\t'The further, the brighter'"
complete -c binspace -n "__fish_binspace_using_subcommand render" -l heuristic -d 'How to choose the planes; `binspace stats -h` lists the ways' -r
complete -c binspace -n "__fish_binspace_using_subcommand render" -l tolerance -d 'Distance within which points lie on a plane [default: by the input\'s digits]' -r
complete -c binspace -n "__fish_binspace_using_subcommand render" -l max-fragments -d 'Largest number of fragments' -r
complete -c binspace -n "__fish_binspace_using_subcommand render" -l threads -d 'Number of threads [default: one for each processor]' -r
complete -c binspace -n "__fish_binspace_using_subcommand render" -l z-buffer -d 'Draw the picture of a depth buffer'
complete -c binspace -n "__fish_binspace_using_subcommand render" -l difference -d 'Draw where painter and depth buffer differ; exit status 1 if they do'
complete -c binspace -n "__fish_binspace_using_subcommand render" -l quiet -d 'Print only errors: neither notes nor progress'
complete -c binspace -n "__fish_binspace_using_subcommand render" -l notes -d 'Print each note in full, in a line of its own'
complete -c binspace -n "__fish_binspace_using_subcommand render" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l seed -d 'Seed of random built-in scenes and of random views' -r
complete -c binspace -n "__fish_binspace_using_subcommand draw" -s o -l output -d 'File to write: .svg, .pdf, .tex, .dxf or .png; - for standard output' -r -F
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l format -d 'Format to write [default: by the file\'s name; svg for standard output]' -r -f -a "svg\t''
pdf\t''
tex\t''
dxf\t''
png\t''"
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l eye -d 'Position of the eye' -r
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l direction -d 'Direction of view of a parallel projection' -r
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l view -d 'Parallel view by name: front, top, right or iso' -r -f -a "front\t'Horizontally: along y if z is up, against z if y is up'
top\t'From above'
right\t'Horizontally, from the right of the front view'
iso\t'Isometric: from the front, the right and above alike'"
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l target -d 'Point in the middle of the picture [default: the scene\'s middle]' -r
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l up -d 'Direction that points up: auto, x, y, z, -x or X,Y,Z' -r
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l fov -d 'Vertical field of view in degrees' -r
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l size -d 'Size of the picture in pixels' -r
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l margin -d 'Empty share of the picture on each side of a whole scene, in percent' -r
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l scale -d 'Millimetres of paper for each unit of the scene, with --view or --direction' -r
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l edges -d 'Edges to draw: none, all, creases[=DEG] or silhouettes [default: none; creases with --lines, --hidden or a DXF]' -r
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l hidden -d 'Hidden parts of edges: none, dashed or layers (by depth)' -r -f -a "dashed\t'Dashed, and thinner'
layers\t'Dashed the more sparsely the more polygons lie in front: one, two, three, or more'
none\t'Not at all'"
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l line-width -d 'Width of lines in pixels' -r
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l colours -d 'Colours by material or polygon' -r -f -a "material\t'From their materials; grey without one'
polygon\t'A different one for each polygon'"
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l cull -d 'Sides of polygons to leave out: none or back' -r -f -a "none\t'Neither: polygons are seen from both sides'
back\t'Backs: polygons are seen only where their corners run counter-clockwise'"
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l background -d 'Colour behind the scene, such as #ffeecc, or none' -r
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l seams -d 'How to avoid light seams between neighbours' -r -f -a "trap\t'Opaque polygons reach a little under later opaque neighbours; translucent ones have seams'
plus-lighter\t'SVG only: a path for each region where the same polygons show, with their blended colour; viewers add the paths up (`mix-blend-mode: plus-lighter`), which leaves no seam, translucent or not'
none\t'Nothing: paths are the polygons alone'"
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l min-size -d 'Leave out polygons of less than PX x PX pixels and shorter lines [default: 0.01; 0 in PNG]' -r
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l heuristic -d 'How to choose the planes; `binspace stats -h` lists the ways' -r
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l tolerance -d 'Distance within which points lie on a plane [default: by the input\'s digits]' -r
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l max-fragments -d 'Largest number of fragments' -r
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l threads -d 'Number of threads [default: one for each processor]' -r
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l ids -d 'Write the numbers of polygons and edges and the names of materials into the SVG'
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l json -d 'Print the figures of the drawing as one JSON object'
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l lines -d 'Draw lines alone; polygons still hide lines behind them'
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l opaque -d 'Draw translucent polygons as opaque ones'
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l translucent -d 'Draw hidden polygons too, below those that hide them'
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l quiet -d 'Print only errors: neither notes nor progress'
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l notes -d 'Print each note in full, in a line of its own'
complete -c binspace -n "__fish_binspace_using_subcommand draw" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c binspace -n "__fish_binspace_using_subcommand page" -l seed -d 'Seed of random built-in scenes and of random views' -r
complete -c binspace -n "__fish_binspace_using_subcommand page" -s o -l output -d 'File to write, such as scene.html; - for standard output' -r -F
complete -c binspace -n "__fish_binspace_using_subcommand page" -l up -d 'Direction that points up: auto, x, y, z, -x or X,Y,Z' -r
complete -c binspace -n "__fish_binspace_using_subcommand page" -l cull -d 'Sides of polygons to leave out: none or back' -r -f -a "none\t'Neither: polygons are seen from both sides'
back\t'Backs: polygons are seen only where their corners run counter-clockwise'"
complete -c binspace -n "__fish_binspace_using_subcommand page" -l heuristic -d 'How to choose the planes; `binspace stats -h` lists the ways' -r
complete -c binspace -n "__fish_binspace_using_subcommand page" -l tolerance -d 'Distance within which points lie on a plane [default: by the input\'s digits]' -r
complete -c binspace -n "__fish_binspace_using_subcommand page" -l max-fragments -d 'Largest number of fragments' -r
complete -c binspace -n "__fish_binspace_using_subcommand page" -l threads -d 'Number of threads [default: one for each processor]' -r
complete -c binspace -n "__fish_binspace_using_subcommand page" -l quiet -d 'Print only errors: neither notes nor progress'
complete -c binspace -n "__fish_binspace_using_subcommand page" -l notes -d 'Print each note in full, in a line of its own'
complete -c binspace -n "__fish_binspace_using_subcommand page" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c binspace -n "__fish_binspace_using_subcommand export" -l seed -d 'Seed of random built-in scenes and of random views' -r
complete -c binspace -n "__fish_binspace_using_subcommand export" -s o -l output -d 'File to write: .obj (and .mtl), .ply or .glb; - for standard output' -r -F
complete -c binspace -n "__fish_binspace_using_subcommand export" -l format -d 'Format of the file [default: by its name; obj for standard output]' -r -f -a "obj\t''
ply\t''
glb\t''"
complete -c binspace -n "__fish_binspace_using_subcommand export" -l order -d 'Sort the triangles back to front for this eye' -r
complete -c binspace -n "__fish_binspace_using_subcommand export" -l heuristic -d 'How to choose the planes; `binspace stats -h` lists the ways' -r
complete -c binspace -n "__fish_binspace_using_subcommand export" -l tolerance -d 'Distance within which points lie on a plane [default: by the input\'s digits]' -r
complete -c binspace -n "__fish_binspace_using_subcommand export" -l max-fragments -d 'Largest number of fragments' -r
complete -c binspace -n "__fish_binspace_using_subcommand export" -l threads -d 'Number of threads [default: one for each processor]' -r
complete -c binspace -n "__fish_binspace_using_subcommand export" -l unwelded -d 'Leave out the vertices that keep closed bodies closed'
complete -c binspace -n "__fish_binspace_using_subcommand export" -l quiet -d 'Print only errors: neither notes nor progress'
complete -c binspace -n "__fish_binspace_using_subcommand export" -l notes -d 'Print each note in full, in a line of its own'
complete -c binspace -n "__fish_binspace_using_subcommand export" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c binspace -n "__fish_binspace_using_subcommand build" -l seed -d 'Seed of random built-in scenes and of random views' -r
complete -c binspace -n "__fish_binspace_using_subcommand build" -s o -l output -d 'File to write, such as scene.bsp, or - for standard output; with --cells, a new folder' -r -F
complete -c binspace -n "__fish_binspace_using_subcommand build" -l cells -d 'Divide a scene too large for memory into N cells, for order, stats and render' -r
complete -c binspace -n "__fish_binspace_using_subcommand build" -l heuristic -d 'How to choose the planes; `binspace stats -h` lists the ways' -r
complete -c binspace -n "__fish_binspace_using_subcommand build" -l tolerance -d 'Distance within which points lie on a plane [default: by the input\'s digits]' -r
complete -c binspace -n "__fish_binspace_using_subcommand build" -l max-fragments -d 'Largest number of fragments' -r
complete -c binspace -n "__fish_binspace_using_subcommand build" -l threads -d 'Number of threads [default: one for each processor]' -r
complete -c binspace -n "__fish_binspace_using_subcommand build" -l quiet -d 'Print only errors: neither notes nor progress'
complete -c binspace -n "__fish_binspace_using_subcommand build" -l notes -d 'Print each note in full, in a line of its own'
complete -c binspace -n "__fish_binspace_using_subcommand build" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c binspace -n "__fish_binspace_using_subcommand scenes" -l threads -d 'Number of threads [default: one for each processor]' -r
complete -c binspace -n "__fish_binspace_using_subcommand scenes" -l quiet -d 'Print only errors: neither notes nor progress'
complete -c binspace -n "__fish_binspace_using_subcommand scenes" -l notes -d 'Print each note in full, in a line of its own'
complete -c binspace -n "__fish_binspace_using_subcommand scenes" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c binspace -n "__fish_binspace_using_subcommand generate" -l threads -d 'Number of threads [default: one for each processor]' -r
complete -c binspace -n "__fish_binspace_using_subcommand generate" -l quiet -d 'Print only errors: neither notes nor progress'
complete -c binspace -n "__fish_binspace_using_subcommand generate" -l notes -d 'Print each note in full, in a line of its own'
complete -c binspace -n "__fish_binspace_using_subcommand generate" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c binspace -n "__fish_binspace_using_subcommand help; and not __fish_seen_subcommand_from demo order verify stats render draw page export build scenes generate help" -f -a "demo" -d 'Draw built-in scenes, and compare every pixel with a depth buffer'
complete -c binspace -n "__fish_binspace_using_subcommand help; and not __fish_seen_subcommand_from demo order verify stats render draw page export build scenes generate help" -f -a "order" -d 'Write a scene\'s fragments in paint order, one JSON object a line'
complete -c binspace -n "__fish_binspace_using_subcommand help; and not __fish_seen_subcommand_from demo order verify stats render draw page export build scenes generate help" -f -a "verify" -d 'Paint a scene in order and compare every pixel with a depth buffer'
complete -c binspace -n "__fish_binspace_using_subcommand help; and not __fish_seen_subcommand_from demo order verify stats render draw page export build scenes generate help" -f -a "stats" -d 'Build trees of a scene and print their figures'
complete -c binspace -n "__fish_binspace_using_subcommand help; and not __fish_seen_subcommand_from demo order verify stats render draw page export build scenes generate help" -f -a "render" -d 'Draw a scene as pixels: a PNG'
complete -c binspace -n "__fish_binspace_using_subcommand help; and not __fish_seen_subcommand_from demo order verify stats render draw page export build scenes generate help" -f -a "draw" -d 'Draw a view as vectors: SVG, PDF, TikZ or DXF, one path a visible polygon, or lines'
complete -c binspace -n "__fish_binspace_using_subcommand help; and not __fish_seen_subcommand_from demo order verify stats render draw page export build scenes generate help" -f -a "page" -d 'Write a self-contained page in which people turn the scene, for a browser'
complete -c binspace -n "__fish_binspace_using_subcommand help; and not __fish_seen_subcommand_from demo order verify stats render draw page export build scenes generate help" -f -a "export" -d 'Write a tree\'s fragments as triangles, for other programs'
complete -c binspace -n "__fish_binspace_using_subcommand help; and not __fish_seen_subcommand_from demo order verify stats render draw page export build scenes generate help" -f -a "build" -d 'Build a scene\'s tree and write it to a file that every command takes as a scene'
complete -c binspace -n "__fish_binspace_using_subcommand help; and not __fish_seen_subcommand_from demo order verify stats render draw page export build scenes generate help" -f -a "scenes" -d 'List the built-in scenes'
complete -c binspace -n "__fish_binspace_using_subcommand help; and not __fish_seen_subcommand_from demo order verify stats render draw page export build scenes generate help" -f -a "generate" -d 'Write completions of shells and manual pages into DIR'
complete -c binspace -n "__fish_binspace_using_subcommand help; and not __fish_seen_subcommand_from demo order verify stats render draw page export build scenes generate help" -f -a "help" -d 'Print this message or the help of the given subcommand(s)'
