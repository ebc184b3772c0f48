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

complete -c binspace -n "__fish_binspace_needs_command" -l threads -d 'Number of threads [default: one per processor]' -r
complete -c binspace -n "__fish_binspace_needs_command" -l quiet -d 'Print errors only: no notes, no progress'
complete -c binspace -n "__fish_binspace_needs_command" -l notes -d 'Print each note in full, on its own line'
complete -c binspace -n "__fish_binspace_needs_command" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c binspace -n "__fish_binspace_needs_command" -s V -l version -d 'Print version'
complete -c binspace -n "__fish_binspace_needs_command" -f -a "demo" -d 'Draw built-in scenes and compare every pixel with a depth buffer'
complete -c binspace -n "__fish_binspace_needs_command" -f -a "order" -d 'Write a scene\'s fragments in painting order, one JSON object per line'
complete -c binspace -n "__fish_binspace_needs_command" -f -a "verify" -d 'Paint a scene in order and compare every pixel with a depth buffer'
complete -c binspace -n "__fish_binspace_needs_command" -f -a "stats" -d 'Build trees of a scene and print their sizes and times'
complete -c binspace -n "__fish_binspace_needs_command" -f -a "render" -d 'Draw a scene as pixels, in a PNG'
complete -c binspace -n "__fish_binspace_needs_command" -f -a "draw" -d 'Draw a scene as vectors (SVG, PDF, TikZ, DXF): one path per visible polygon, or lines'
complete -c binspace -n "__fish_binspace_needs_command" -f -a "page" -d 'Write a page for a browser, in which readers turn the scene'
complete -c binspace -n "__fish_binspace_needs_command" -f -a "export" -d 'Write a tree\'s fragments as triangles, for other programs'
complete -c binspace -n "__fish_binspace_needs_command" -f -a "build" -d 'Build a scene\'s tree and store both in a file that every command accepts as SCENE'
complete -c binspace -n "__fish_binspace_needs_command" -f -a "scenes" -d 'List the built-in scenes'
complete -c binspace -n "__fish_binspace_needs_command" -f -a "generate" -d 'Write shell completions and manual pages into DIR'
complete -c binspace -n "__fish_binspace_needs_command" -f -a "help" -d 'Print this message or the help of the given subcommand(s)'
complete -c binspace -n "__fish_binspace_using_subcommand demo" -s o -l output -d 'Folder for the pictures; created if it is missing' -r -F
complete -c binspace -n "__fish_binspace_using_subcommand demo" -l views -d 'Number of views to compare, around each scene and inside it' -r
complete -c binspace -n "__fish_binspace_using_subcommand demo" -l size -d 'Size of the pictures in pixels' -r
complete -c binspace -n "__fish_binspace_using_subcommand demo" -l seed -d 'Seed of random scenes and views' -r
complete -c binspace -n "__fish_binspace_using_subcommand demo" -l threads -d 'Number of threads [default: one per processor]' -r
complete -c binspace -n "__fish_binspace_using_subcommand demo" -l quiet -d 'Print errors only: no notes, no progress'
complete -c binspace -n "__fish_binspace_using_subcommand demo" -l notes -d 'Print each note in full, on its own line'
complete -c binspace -n "__fish_binspace_using_subcommand demo" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c binspace -n "__fish_binspace_using_subcommand order" -l seed -d 'Seed of random built-in scenes and of random views' -r
complete -c binspace -n "__fish_binspace_using_subcommand order" -l eye -d 'Position of the eye; repeat the option for more eyes' -r
complete -c binspace -n "__fish_binspace_using_subcommand order" -l direction -d 'Direction of view, for an eye infinitely far away' -r
complete -c binspace -n "__fish_binspace_using_subcommand order" -l cull -d 'Sides of polygons to omit: none or back' -r -f -a "none\t'None: polygons are visible from both sides'
back\t'Back faces: polygons are visible only where their corners run counter-clockwise'"
complete -c binspace -n "__fish_binspace_using_subcommand order" -s o -l output -d 'File to write; - for standard output' -r -F
complete -c binspace -n "__fish_binspace_using_subcommand order" -l heuristic -d 'Heuristic to choose splitting planes: see `binspace stats -h`' -r
complete -c binspace -n "__fish_binspace_using_subcommand order" -l tolerance -d 'Points this close to a plane lie on it [default: by the input\'s precision]' -r
complete -c binspace -n "__fish_binspace_using_subcommand order" -l max-fragments -d 'Stop with an error if the tree needs more fragments' -r
complete -c binspace -n "__fish_binspace_using_subcommand order" -l threads -d 'Number of threads [default: one per processor]' -r
complete -c binspace -n "__fish_binspace_using_subcommand order" -l front-to-back -d 'List the nearest fragment first'
complete -c binspace -n "__fish_binspace_using_subcommand order" -l edges -d 'Add the number of the polygon\'s edge on which each edge lies'
complete -c binspace -n "__fish_binspace_using_subcommand order" -l weights -d 'Add weights of the polygon\'s corners for each vertex, to interpolate attributes'
complete -c binspace -n "__fish_binspace_using_subcommand order" -l quiet -d 'Print errors only: no notes, no progress'
complete -c binspace -n "__fish_binspace_using_subcommand order" -l notes -d 'Print each note in full, on its own line'
complete -c binspace -n "__fish_binspace_using_subcommand order" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c binspace -n "__fish_binspace_using_subcommand verify" -l seed -d 'Seed of random built-in scenes and of random views' -r
complete -c binspace -n "__fish_binspace_using_subcommand verify" -l views -d 'Number of views to compare, alternately around the scene and inside it' -r
complete -c binspace -n "__fish_binspace_using_subcommand verify" -l size -d 'Size of the pictures in pixels' -r
complete -c binspace -n "__fish_binspace_using_subcommand verify" -l up -d 'Direction that points up: auto, x, y, z, -x or X,Y,Z' -r
complete -c binspace -n "__fish_binspace_using_subcommand verify" -l cull -d 'Sides of polygons to omit: none or back' -r -f -a "none\t'None: polygons are visible from both sides'
back\t'Back faces: polygons are visible only where their corners run counter-clockwise'"
complete -c binspace -n "__fish_binspace_using_subcommand verify" -l heuristic -d 'Heuristic to choose splitting planes: see `binspace stats -h`' -r
complete -c binspace -n "__fish_binspace_using_subcommand verify" -l tolerance -d 'Points this close to a plane lie on it [default: by the input\'s precision]' -r
complete -c binspace -n "__fish_binspace_using_subcommand verify" -l max-fragments -d 'Stop with an error if the tree needs more fragments' -r
complete -c binspace -n "__fish_binspace_using_subcommand verify" -l threads -d 'Number of threads [default: one per processor]' -r
complete -c binspace -n "__fish_binspace_using_subcommand verify" -l json -d 'Print a JSON object for each view and one for the total'
complete -c binspace -n "__fish_binspace_using_subcommand verify" -l quiet -d 'Print errors only: no notes, no progress'
complete -c binspace -n "__fish_binspace_using_subcommand verify" -l notes -d 'Print each note in full, on its own line'
complete -c binspace -n "__fish_binspace_using_subcommand verify" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c binspace -n "__fish_binspace_using_subcommand stats" -l seed -d 'Seed of random built-in scenes and of random views' -r
complete -c binspace -n "__fish_binspace_using_subcommand stats" -l heuristic -d 'Heuristic to choose splitting planes: a name from below, or all' -r
complete -c binspace -n "__fish_binspace_using_subcommand stats" -l tolerance -d 'Points this close to a plane lie on it [default: by the input\'s precision]' -r
complete -c binspace -n "__fish_binspace_using_subcommand stats" -l max-fragments -d 'Stop with an error if the tree needs more fragments' -r
complete -c binspace -n "__fish_binspace_using_subcommand stats" -l threads -d 'Number of threads [default: one per processor]' -r
complete -c binspace -n "__fish_binspace_using_subcommand stats" -l json -d 'Print a JSON object for each tree'
complete -c binspace -n "__fish_binspace_using_subcommand stats" -l quiet -d 'Print errors only: no notes, no progress'
complete -c binspace -n "__fish_binspace_using_subcommand stats" -l notes -d 'Print each note in full, on its own line'
complete -c binspace -n "__fish_binspace_using_subcommand stats" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c binspace -n "__fish_binspace_using_subcommand render" -l seed -d 'Seed of random built-in scenes and of random views' -r
complete -c binspace -n "__fish_binspace_using_subcommand render" -s o -l output -d 'PNG file to write; - for standard output' -r -F
complete -c binspace -n "__fish_binspace_using_subcommand render" -l eye -d 'Position of the eye' -r
complete -c binspace -n "__fish_binspace_using_subcommand render" -l direction -d 'Direction of view of a parallel projection' -r
complete -c binspace -n "__fish_binspace_using_subcommand render" -l view -d 'Parallel view by name: front, top, right or iso' -r -f -a "front\t'Horizontal: towards +y if z is up, towards -z if y is up'
top\t'From above'
right\t'Horizontal: from the right side of the front view'
iso\t'Isometric: equally from the front, the right and above'"
complete -c binspace -n "__fish_binspace_using_subcommand render" -l target -d 'Point at the centre of the picture [default: the scene\'s centre]' -r
complete -c binspace -n "__fish_binspace_using_subcommand render" -l up -d 'Direction that points up: auto, x, y, z, -x or X,Y,Z' -r
complete -c binspace -n "__fish_binspace_using_subcommand render" -l fov -d 'Vertical field of view in degrees' -r
complete -c binspace -n "__fish_binspace_using_subcommand render" -l size -d 'Size of the picture in pixels' -r
complete -c binspace -n "__fish_binspace_using_subcommand render" -l margin -d 'Empty border around a whole scene, in percent of the picture on each side' -r
complete -c binspace -n "__fish_binspace_using_subcommand render" -l colours -d 'Colour by material or by polygon' -r -f -a "material\t'The colour of the material; grey without a material'
polygon\t'A different colour for each polygon'"
complete -c binspace -n "__fish_binspace_using_subcommand render" -l cull -d 'Sides of polygons to omit: none or back' -r -f -a "none\t'None: polygons are visible from both sides'
back\t'Back faces: polygons are visible only where their corners run counter-clockwise'"
complete -c binspace -n "__fish_binspace_using_subcommand render" -l samples -d 'Antialias: N x N samples per pixel' -r
complete -c binspace -n "__fish_binspace_using_subcommand render" -l depth -d 'Draw depths: near is bright; with --depth=far, far is bright' -r -f -a "near\t'Near is bright'
far\t'Far is bright'"
complete -c binspace -n "__fish_binspace_using_subcommand render" -l heuristic -d 'Heuristic to choose splitting planes: see `binspace stats -h`' -r
complete -c binspace -n "__fish_binspace_using_subcommand render" -l tolerance -d 'Points this close to a plane lie on it [default: by the input\'s precision]' -r
complete -c binspace -n "__fish_binspace_using_subcommand render" -l max-fragments -d 'Stop with an error if the tree needs more fragments' -r
complete -c binspace -n "__fish_binspace_using_subcommand render" -l threads -d 'Number of threads [default: one per processor]' -r
complete -c binspace -n "__fish_binspace_using_subcommand render" -l z-buffer -d 'Draw with a depth buffer'
complete -c binspace -n "__fish_binspace_using_subcommand render" -l difference -d 'Draw where painter and depth buffer differ; exit status 1 if they do'
complete -c binspace -n "__fish_binspace_using_subcommand render" -l quiet -d 'Print errors only: no notes, no progress'
complete -c binspace -n "__fish_binspace_using_subcommand render" -l notes -d 'Print each note in full, on its own line'
complete -c binspace -n "__fish_binspace_using_subcommand render" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l seed -d 'Seed of random built-in scenes and of random views' -r
complete -c binspace -n "__fish_binspace_using_subcommand draw" -s o -l output -d 'File to write: .svg, .pdf, .tex, .dxf or .png; - for standard output' -r -F
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l format -d 'File format [default: by the file\'s name; svg for standard output]' -r -f -a "svg\t''
pdf\t''
tex\t''
dxf\t''
png\t''"
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l eye -d 'Position of the eye' -r
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l direction -d 'Direction of view of a parallel projection' -r
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l view -d 'Parallel view by name: front, top, right or iso' -r -f -a "front\t'Horizontal: towards +y if z is up, towards -z if y is up'
top\t'From above'
right\t'Horizontal: from the right side of the front view'
iso\t'Isometric: equally from the front, the right and above'"
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l target -d 'Point at the centre of the picture [default: the scene\'s centre]' -r
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l up -d 'Direction that points up: auto, x, y, z, -x or X,Y,Z' -r
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l fov -d 'Vertical field of view in degrees' -r
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l size -d 'Size of the picture in pixels' -r
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l margin -d 'Empty border around a whole scene, in percent of the picture on each side' -r
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l scale -d 'Millimetres of paper per unit of the scene; needs --view or --direction' -r
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l edges -d 'Edges to draw: none, all, creases[=DEG] or silhouettes [default: none; creases with --lines, --hidden or a DXF]' -r
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l hidden -d 'Hidden edges: none, dashed or layers (dashed by depth)' -r -f -a "dashed\t'Dashed and thinner'
layers\t'Dashed, with sparser dashes behind two, three, or more polygons'
none\t'Not drawn'"
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l line-width -d 'Width of lines in pixels' -r
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l colours -d 'Colour by material or by polygon' -r -f -a "material\t'The colour of the material; grey without a material'
polygon\t'A different colour for each polygon'"
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l cull -d 'Sides of polygons to omit: none or back' -r -f -a "none\t'None: polygons are visible from both sides'
back\t'Back faces: polygons are visible only where their corners run counter-clockwise'"
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l background -d 'Colour behind the scene, such as #ffeecc, or none' -r
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l seams -d 'How to avoid light seams between adjacent polygons' -r -f -a "trap\t'Extend opaque polygons a little under opaque neighbours that are painted later; translucent polygons keep their seams'
plus-lighter\t'SVG only: write a path for each region in which the same polygons are visible, in their blended colour; viewers add the paths up (`mix-blend-mode: plus-lighter`), and no seam remains'
none\t'Leave the seams: each path is exactly its polygon'"
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l min-size -d 'Omit polygons with less visible area than PX x PX pixels, and lines shorter than PX [default: 0.01; 0 in a PNG]' -r
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l heuristic -d 'Heuristic to choose splitting planes: see `binspace stats -h`' -r
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l tolerance -d 'Points this close to a plane lie on it [default: by the input\'s precision]' -r
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l max-fragments -d 'Stop with an error if the tree needs more fragments' -r
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l threads -d 'Number of threads [default: one per processor]' -r
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l ids -d 'Write polygon numbers, edge numbers and material names into the SVG'
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l json -d 'Print statistics of the drawing as a JSON object'
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l lines -d 'Draw only lines; polygons still hide the lines behind them'
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l opaque -d 'Ignore opacities: draw all polygons as opaque'
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l translucent -d 'Draw hidden polygons too, under the polygons in front of them'
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l quiet -d 'Print errors only: no notes, no progress'
complete -c binspace -n "__fish_binspace_using_subcommand draw" -l notes -d 'Print each note in full, on its own line'
complete -c binspace -n "__fish_binspace_using_subcommand draw" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c binspace -n "__fish_binspace_using_subcommand page" -l seed -d 'Seed of random built-in scenes and of random views' -r
complete -c binspace -n "__fish_binspace_using_subcommand page" -s o -l output -d 'File to write, such as scene.html; - for standard output' -r -F
complete -c binspace -n "__fish_binspace_using_subcommand page" -l up -d 'Direction that points up: auto, x, y, z, -x or X,Y,Z' -r
complete -c binspace -n "__fish_binspace_using_subcommand page" -l cull -d 'Sides of polygons to omit: none or back' -r -f -a "none\t'None: polygons are visible from both sides'
back\t'Back faces: polygons are visible only where their corners run counter-clockwise'"
complete -c binspace -n "__fish_binspace_using_subcommand page" -l heuristic -d 'Heuristic to choose splitting planes: see `binspace stats -h`' -r
complete -c binspace -n "__fish_binspace_using_subcommand page" -l tolerance -d 'Points this close to a plane lie on it [default: by the input\'s precision]' -r
complete -c binspace -n "__fish_binspace_using_subcommand page" -l max-fragments -d 'Stop with an error if the tree needs more fragments' -r
complete -c binspace -n "__fish_binspace_using_subcommand page" -l threads -d 'Number of threads [default: one per processor]' -r
complete -c binspace -n "__fish_binspace_using_subcommand page" -l quiet -d 'Print errors only: no notes, no progress'
complete -c binspace -n "__fish_binspace_using_subcommand page" -l notes -d 'Print each note in full, on its own line'
complete -c binspace -n "__fish_binspace_using_subcommand page" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c binspace -n "__fish_binspace_using_subcommand export" -l seed -d 'Seed of random built-in scenes and of random views' -r
complete -c binspace -n "__fish_binspace_using_subcommand export" -s o -l output -d 'File to write: .obj (and .mtl), .ply or .glb; - for standard output' -r -F
complete -c binspace -n "__fish_binspace_using_subcommand export" -l format -d 'File format [default: by the file\'s name; obj for standard output]' -r -f -a "obj\t''
ply\t''
glb\t''"
complete -c binspace -n "__fish_binspace_using_subcommand export" -l order -d 'Sort the triangles back to front for this eye' -r
complete -c binspace -n "__fish_binspace_using_subcommand export" -l heuristic -d 'Heuristic to choose splitting planes: see `binspace stats -h`' -r
complete -c binspace -n "__fish_binspace_using_subcommand export" -l tolerance -d 'Points this close to a plane lie on it [default: by the input\'s precision]' -r
complete -c binspace -n "__fish_binspace_using_subcommand export" -l max-fragments -d 'Stop with an error if the tree needs more fragments' -r
complete -c binspace -n "__fish_binspace_using_subcommand export" -l threads -d 'Number of threads [default: one per processor]' -r
complete -c binspace -n "__fish_binspace_using_subcommand export" -l unwelded -d 'Leave T-junctions between fragments open: fewer triangles, but cracks'
complete -c binspace -n "__fish_binspace_using_subcommand export" -l quiet -d 'Print errors only: no notes, no progress'
complete -c binspace -n "__fish_binspace_using_subcommand export" -l notes -d 'Print each note in full, on its own line'
complete -c binspace -n "__fish_binspace_using_subcommand export" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c binspace -n "__fish_binspace_using_subcommand build" -l seed -d 'Seed of random built-in scenes and of random views' -r
complete -c binspace -n "__fish_binspace_using_subcommand build" -s o -l output -d 'File to write, such as scene.bsp; - for standard output; with --cells, a new folder' -r -F
complete -c binspace -n "__fish_binspace_using_subcommand build" -l cells -d 'Divide a scene larger than memory into N cells; order, stats and render accept the folder' -r
complete -c binspace -n "__fish_binspace_using_subcommand build" -l heuristic -d 'Heuristic to choose splitting planes: see `binspace stats -h`' -r
complete -c binspace -n "__fish_binspace_using_subcommand build" -l tolerance -d 'Points this close to a plane lie on it [default: by the input\'s precision]' -r
complete -c binspace -n "__fish_binspace_using_subcommand build" -l max-fragments -d 'Stop with an error if the tree needs more fragments' -r
complete -c binspace -n "__fish_binspace_using_subcommand build" -l threads -d 'Number of threads [default: one per processor]' -r
complete -c binspace -n "__fish_binspace_using_subcommand build" -l quiet -d 'Print errors only: no notes, no progress'
complete -c binspace -n "__fish_binspace_using_subcommand build" -l notes -d 'Print each note in full, on its own line'
complete -c binspace -n "__fish_binspace_using_subcommand build" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c binspace -n "__fish_binspace_using_subcommand scenes" -l threads -d 'Number of threads [default: one per processor]' -r
complete -c binspace -n "__fish_binspace_using_subcommand scenes" -l quiet -d 'Print errors only: no notes, no progress'
complete -c binspace -n "__fish_binspace_using_subcommand scenes" -l notes -d 'Print each note in full, on its own line'
complete -c binspace -n "__fish_binspace_using_subcommand scenes" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c binspace -n "__fish_binspace_using_subcommand generate" -l threads -d 'Number of threads [default: one per processor]' -r
complete -c binspace -n "__fish_binspace_using_subcommand generate" -l quiet -d 'Print errors only: no notes, no progress'
complete -c binspace -n "__fish_binspace_using_subcommand generate" -l notes -d 'Print each note in full, on its own line'
complete -c binspace -n "__fish_binspace_using_subcommand generate" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c binspace -n "__fish_binspace_using_subcommand help; and not __fish_seen_subcommand_from demo order verify stats render draw page export build scenes generate help" -f -a "demo" -d 'Draw built-in scenes and compare every pixel with a depth buffer'
complete -c binspace -n "__fish_binspace_using_subcommand help; and not __fish_seen_subcommand_from demo order verify stats render draw page export build scenes generate help" -f -a "order" -d 'Write a scene\'s fragments in painting order, one JSON object per line'
complete -c binspace -n "__fish_binspace_using_subcommand help; and not __fish_seen_subcommand_from demo order verify stats render draw page export build scenes generate help" -f -a "verify" -d 'Paint a scene in order and compare every pixel with a depth buffer'
complete -c binspace -n "__fish_binspace_using_subcommand help; and not __fish_seen_subcommand_from demo order verify stats render draw page export build scenes generate help" -f -a "stats" -d 'Build trees of a scene and print their sizes and times'
complete -c binspace -n "__fish_binspace_using_subcommand help; and not __fish_seen_subcommand_from demo order verify stats render draw page export build scenes generate help" -f -a "render" -d 'Draw a scene as pixels, in a PNG'
complete -c binspace -n "__fish_binspace_using_subcommand help; and not __fish_seen_subcommand_from demo order verify stats render draw page export build scenes generate help" -f -a "draw" -d 'Draw a scene as vectors (SVG, PDF, TikZ, DXF): one path per visible polygon, or lines'
complete -c binspace -n "__fish_binspace_using_subcommand help; and not __fish_seen_subcommand_from demo order verify stats render draw page export build scenes generate help" -f -a "page" -d 'Write a page for a browser, in which readers turn the scene'
complete -c binspace -n "__fish_binspace_using_subcommand help; and not __fish_seen_subcommand_from demo order verify stats render draw page export build scenes generate help" -f -a "export" -d 'Write a tree\'s fragments as triangles, for other programs'
complete -c binspace -n "__fish_binspace_using_subcommand help; and not __fish_seen_subcommand_from demo order verify stats render draw page export build scenes generate help" -f -a "build" -d 'Build a scene\'s tree and store both in a file that every command accepts as SCENE'
complete -c binspace -n "__fish_binspace_using_subcommand help; and not __fish_seen_subcommand_from demo order verify stats render draw page export build scenes generate help" -f -a "scenes" -d 'List the built-in scenes'
complete -c binspace -n "__fish_binspace_using_subcommand help; and not __fish_seen_subcommand_from demo order verify stats render draw page export build scenes generate help" -f -a "generate" -d 'Write shell completions and manual pages into DIR'
complete -c binspace -n "__fish_binspace_using_subcommand help; and not __fish_seen_subcommand_from demo order verify stats render draw page export build scenes generate help" -f -a "help" -d 'Print this message or the help of the given subcommand(s)'
