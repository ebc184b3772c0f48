
using namespace System.Management.Automation
using namespace System.Management.Automation.Language

Register-ArgumentCompleter -Native -CommandName 'binspace' -ScriptBlock {
    param($wordToComplete, $commandAst, $cursorPosition)

    $commandElements = $commandAst.CommandElements
    $command = @(
        'binspace'
        for ($i = 1; $i -lt $commandElements.Count; $i++) {
            $element = $commandElements[$i]
            if ($element -isnot [StringConstantExpressionAst] -or
                $element.StringConstantType -ne [StringConstantType]::BareWord -or
                $element.Value.StartsWith('-') -or
                $element.Value -eq $wordToComplete) {
                break
        }
        $element.Value
    }) -join ';'

    $completions = @(switch ($command) {
        'binspace' {
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'Number of threads [default: one for each processor]')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print only errors: neither notes nor progress')
            [CompletionResult]::new('--notes', '--notes', [CompletionResultType]::ParameterName, 'Print each note in full, in a line of its own')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('-V', '-V ', [CompletionResultType]::ParameterName, 'Print version')
            [CompletionResult]::new('--version', '--version', [CompletionResultType]::ParameterName, 'Print version')
            [CompletionResult]::new('demo', 'demo', [CompletionResultType]::ParameterValue, 'Draw built-in scenes, and compare every pixel with a depth buffer')
            [CompletionResult]::new('order', 'order', [CompletionResultType]::ParameterValue, 'Write a scene''s fragments in paint order, one JSON object a line')
            [CompletionResult]::new('verify', 'verify', [CompletionResultType]::ParameterValue, 'Paint a scene in order and compare every pixel with a depth buffer')
            [CompletionResult]::new('stats', 'stats', [CompletionResultType]::ParameterValue, 'Build trees of a scene and print their figures')
            [CompletionResult]::new('render', 'render', [CompletionResultType]::ParameterValue, 'Draw a scene as pixels: a PNG')
            [CompletionResult]::new('draw', 'draw', [CompletionResultType]::ParameterValue, 'Draw a view as vectors: SVG, PDF, TikZ or DXF, one path a visible polygon, or lines')
            [CompletionResult]::new('page', 'page', [CompletionResultType]::ParameterValue, 'Write a self-contained page in which people turn the scene, for a browser')
            [CompletionResult]::new('export', 'export', [CompletionResultType]::ParameterValue, 'Write a tree''s fragments as triangles, for other programs')
            [CompletionResult]::new('build', 'build', [CompletionResultType]::ParameterValue, 'Build a scene''s tree and write it to a file that every command takes as a scene')
            [CompletionResult]::new('scenes', 'scenes', [CompletionResultType]::ParameterValue, 'List the built-in scenes')
            [CompletionResult]::new('generate', 'generate', [CompletionResultType]::ParameterValue, 'Write completions of shells and manual pages into DIR')
            [CompletionResult]::new('help', 'help', [CompletionResultType]::ParameterValue, 'Print this message or the help of the given subcommand(s)')
            break
        }
        'binspace;demo' {
            [CompletionResult]::new('-o', '-o', [CompletionResultType]::ParameterName, 'Folder to write the pictures into; created if it does not exist')
            [CompletionResult]::new('--output', '--output', [CompletionResultType]::ParameterName, 'Folder to write the pictures into; created if it does not exist')
            [CompletionResult]::new('--views', '--views', [CompletionResultType]::ParameterName, 'Views of each scene to compare, around it and inside it')
            [CompletionResult]::new('--size', '--size', [CompletionResultType]::ParameterName, 'Size of the pictures in pixels')
            [CompletionResult]::new('--seed', '--seed', [CompletionResultType]::ParameterName, 'Seed of the random views')
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'Number of threads [default: one for each processor]')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print only errors: neither notes nor progress')
            [CompletionResult]::new('--notes', '--notes', [CompletionResultType]::ParameterName, 'Print each note in full, in a line of its own')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'binspace;order' {
            [CompletionResult]::new('--seed', '--seed', [CompletionResultType]::ParameterName, 'Seed of random built-in scenes and of random views')
            [CompletionResult]::new('--eye', '--eye', [CompletionResultType]::ParameterName, 'Position of the eye; repeat it for one order for each eye')
            [CompletionResult]::new('--direction', '--direction', [CompletionResultType]::ParameterName, 'Direction of view, from infinitely far away')
            [CompletionResult]::new('--cull', '--cull', [CompletionResultType]::ParameterName, 'Sides of polygons to leave out: none or back')
            [CompletionResult]::new('-o', '-o', [CompletionResultType]::ParameterName, 'File to write [default: standard output, as for -]')
            [CompletionResult]::new('--output', '--output', [CompletionResultType]::ParameterName, 'File to write [default: standard output, as for -]')
            [CompletionResult]::new('--heuristic', '--heuristic', [CompletionResultType]::ParameterName, 'How to choose the planes; `binspace stats -h` lists the ways')
            [CompletionResult]::new('--tolerance', '--tolerance', [CompletionResultType]::ParameterName, 'Distance within which points lie on a plane [default: by the input''s digits]')
            [CompletionResult]::new('--max-fragments', '--max-fragments', [CompletionResultType]::ParameterName, 'Largest number of fragments')
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'Number of threads [default: one for each processor]')
            [CompletionResult]::new('--front-to-back', '--front-to-back', [CompletionResultType]::ParameterName, 'List the nearest fragment first')
            [CompletionResult]::new('--edges', '--edges', [CompletionResultType]::ParameterName, 'Add for each edge the number of the polygon''s edge that it lies on')
            [CompletionResult]::new('--weights', '--weights', [CompletionResultType]::ParameterName, 'Add for each vertex the corners that it lies between, with weights')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print only errors: neither notes nor progress')
            [CompletionResult]::new('--notes', '--notes', [CompletionResultType]::ParameterName, 'Print each note in full, in a line of its own')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'binspace;verify' {
            [CompletionResult]::new('--seed', '--seed', [CompletionResultType]::ParameterName, 'Seed of random built-in scenes and of random views')
            [CompletionResult]::new('--views', '--views', [CompletionResultType]::ParameterName, 'Views to compare, alternately around the scene and inside it')
            [CompletionResult]::new('--size', '--size', [CompletionResultType]::ParameterName, 'Size of the pictures in pixels')
            [CompletionResult]::new('--up', '--up', [CompletionResultType]::ParameterName, 'Direction that points up: auto, x, y, z, -x or X,Y,Z')
            [CompletionResult]::new('--cull', '--cull', [CompletionResultType]::ParameterName, 'Sides of polygons to leave out: none or back')
            [CompletionResult]::new('--heuristic', '--heuristic', [CompletionResultType]::ParameterName, 'How to choose the planes; `binspace stats -h` lists the ways')
            [CompletionResult]::new('--tolerance', '--tolerance', [CompletionResultType]::ParameterName, 'Distance within which points lie on a plane [default: by the input''s digits]')
            [CompletionResult]::new('--max-fragments', '--max-fragments', [CompletionResultType]::ParameterName, 'Largest number of fragments')
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'Number of threads [default: one for each processor]')
            [CompletionResult]::new('--json', '--json', [CompletionResultType]::ParameterName, 'Print a JSON object for each view and for the total')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print only errors: neither notes nor progress')
            [CompletionResult]::new('--notes', '--notes', [CompletionResultType]::ParameterName, 'Print each note in full, in a line of its own')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'binspace;stats' {
            [CompletionResult]::new('--seed', '--seed', [CompletionResultType]::ParameterName, 'Seed of random built-in scenes and of random views')
            [CompletionResult]::new('--heuristic', '--heuristic', [CompletionResultType]::ParameterName, 'Heuristic to choose the planes: one of those below, or all')
            [CompletionResult]::new('--tolerance', '--tolerance', [CompletionResultType]::ParameterName, 'Distance within which points lie on a plane [default: by the input''s digits]')
            [CompletionResult]::new('--max-fragments', '--max-fragments', [CompletionResultType]::ParameterName, 'Largest number of fragments')
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'Number of threads [default: one for each processor]')
            [CompletionResult]::new('--json', '--json', [CompletionResultType]::ParameterName, 'Print a JSON object for each tree')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print only errors: neither notes nor progress')
            [CompletionResult]::new('--notes', '--notes', [CompletionResultType]::ParameterName, 'Print each note in full, in a line of its own')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'binspace;render' {
            [CompletionResult]::new('--seed', '--seed', [CompletionResultType]::ParameterName, 'Seed of random built-in scenes and of random views')
            [CompletionResult]::new('-o', '-o', [CompletionResultType]::ParameterName, 'PNG file to write; - for standard output')
            [CompletionResult]::new('--output', '--output', [CompletionResultType]::ParameterName, 'PNG file to write; - for standard output')
            [CompletionResult]::new('--eye', '--eye', [CompletionResultType]::ParameterName, 'Position of the eye')
            [CompletionResult]::new('--direction', '--direction', [CompletionResultType]::ParameterName, 'Direction of view of a parallel projection')
            [CompletionResult]::new('--view', '--view', [CompletionResultType]::ParameterName, 'Parallel view by name: front, top, right or iso')
            [CompletionResult]::new('--target', '--target', [CompletionResultType]::ParameterName, 'Point in the middle of the picture [default: the scene''s middle]')
            [CompletionResult]::new('--up', '--up', [CompletionResultType]::ParameterName, 'Direction that points up: auto, x, y, z, -x or X,Y,Z')
            [CompletionResult]::new('--fov', '--fov', [CompletionResultType]::ParameterName, 'Vertical field of view in degrees')
            [CompletionResult]::new('--size', '--size', [CompletionResultType]::ParameterName, 'Size of the picture in pixels')
            [CompletionResult]::new('--margin', '--margin', [CompletionResultType]::ParameterName, 'Empty share of the picture on each side of a whole scene, in percent')
            [CompletionResult]::new('--colours', '--colours', [CompletionResultType]::ParameterName, 'Colours by material or polygon')
            [CompletionResult]::new('--cull', '--cull', [CompletionResultType]::ParameterName, 'Sides of polygons to leave out: none or back')
            [CompletionResult]::new('--samples', '--samples', [CompletionResultType]::ParameterName, 'Samples each way in a pixel: with more than 1, edges are smooth')
            [CompletionResult]::new('--depth', '--depth', [CompletionResultType]::ParameterName, 'Draw depths: bright is near or, with --depth=far, far')
            [CompletionResult]::new('--heuristic', '--heuristic', [CompletionResultType]::ParameterName, 'How to choose the planes; `binspace stats -h` lists the ways')
            [CompletionResult]::new('--tolerance', '--tolerance', [CompletionResultType]::ParameterName, 'Distance within which points lie on a plane [default: by the input''s digits]')
            [CompletionResult]::new('--max-fragments', '--max-fragments', [CompletionResultType]::ParameterName, 'Largest number of fragments')
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'Number of threads [default: one for each processor]')
            [CompletionResult]::new('--z-buffer', '--z-buffer', [CompletionResultType]::ParameterName, 'Draw the picture of a depth buffer')
            [CompletionResult]::new('--difference', '--difference', [CompletionResultType]::ParameterName, 'Draw where painter and depth buffer differ; exit status 1 if they do')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print only errors: neither notes nor progress')
            [CompletionResult]::new('--notes', '--notes', [CompletionResultType]::ParameterName, 'Print each note in full, in a line of its own')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'binspace;draw' {
            [CompletionResult]::new('--seed', '--seed', [CompletionResultType]::ParameterName, 'Seed of random built-in scenes and of random views')
            [CompletionResult]::new('-o', '-o', [CompletionResultType]::ParameterName, 'File to write: .svg, .pdf, .tex, .dxf or .png; - for standard output')
            [CompletionResult]::new('--output', '--output', [CompletionResultType]::ParameterName, 'File to write: .svg, .pdf, .tex, .dxf or .png; - for standard output')
            [CompletionResult]::new('--format', '--format', [CompletionResultType]::ParameterName, 'Format to write [default: by the file''s name; svg for standard output]')
            [CompletionResult]::new('--eye', '--eye', [CompletionResultType]::ParameterName, 'Position of the eye')
            [CompletionResult]::new('--direction', '--direction', [CompletionResultType]::ParameterName, 'Direction of view of a parallel projection')
            [CompletionResult]::new('--view', '--view', [CompletionResultType]::ParameterName, 'Parallel view by name: front, top, right or iso')
            [CompletionResult]::new('--target', '--target', [CompletionResultType]::ParameterName, 'Point in the middle of the picture [default: the scene''s middle]')
            [CompletionResult]::new('--up', '--up', [CompletionResultType]::ParameterName, 'Direction that points up: auto, x, y, z, -x or X,Y,Z')
            [CompletionResult]::new('--fov', '--fov', [CompletionResultType]::ParameterName, 'Vertical field of view in degrees')
            [CompletionResult]::new('--size', '--size', [CompletionResultType]::ParameterName, 'Size of the picture in pixels')
            [CompletionResult]::new('--margin', '--margin', [CompletionResultType]::ParameterName, 'Empty share of the picture on each side of a whole scene, in percent')
            [CompletionResult]::new('--scale', '--scale', [CompletionResultType]::ParameterName, 'Millimetres of paper for each unit of the scene, with --view or --direction')
            [CompletionResult]::new('--edges', '--edges', [CompletionResultType]::ParameterName, 'Edges to draw: none, all, creases[=DEG] or silhouettes [default: none; creases with --lines, --hidden or a DXF]')
            [CompletionResult]::new('--hidden', '--hidden', [CompletionResultType]::ParameterName, 'Hidden parts of edges: none, dashed or layers (by depth)')
            [CompletionResult]::new('--line-width', '--line-width', [CompletionResultType]::ParameterName, 'Width of lines in pixels')
            [CompletionResult]::new('--colours', '--colours', [CompletionResultType]::ParameterName, 'Colours by material or polygon')
            [CompletionResult]::new('--cull', '--cull', [CompletionResultType]::ParameterName, 'Sides of polygons to leave out: none or back')
            [CompletionResult]::new('--background', '--background', [CompletionResultType]::ParameterName, 'Colour behind the scene, such as #ffeecc, or none')
            [CompletionResult]::new('--seams', '--seams', [CompletionResultType]::ParameterName, 'How to avoid light seams between neighbours')
            [CompletionResult]::new('--min-size', '--min-size', [CompletionResultType]::ParameterName, 'Leave out polygons of less than PX x PX pixels and shorter lines [default: 0.01; 0 in PNG]')
            [CompletionResult]::new('--heuristic', '--heuristic', [CompletionResultType]::ParameterName, 'How to choose the planes; `binspace stats -h` lists the ways')
            [CompletionResult]::new('--tolerance', '--tolerance', [CompletionResultType]::ParameterName, 'Distance within which points lie on a plane [default: by the input''s digits]')
            [CompletionResult]::new('--max-fragments', '--max-fragments', [CompletionResultType]::ParameterName, 'Largest number of fragments')
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'Number of threads [default: one for each processor]')
            [CompletionResult]::new('--ids', '--ids', [CompletionResultType]::ParameterName, 'Write the numbers of polygons and edges and the names of materials into the SVG')
            [CompletionResult]::new('--json', '--json', [CompletionResultType]::ParameterName, 'Print the figures of the drawing as one JSON object')
            [CompletionResult]::new('--lines', '--lines', [CompletionResultType]::ParameterName, 'Draw lines alone; polygons still hide lines behind them')
            [CompletionResult]::new('--opaque', '--opaque', [CompletionResultType]::ParameterName, 'Draw translucent polygons as opaque ones')
            [CompletionResult]::new('--translucent', '--translucent', [CompletionResultType]::ParameterName, 'Draw hidden polygons too, below those that hide them')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print only errors: neither notes nor progress')
            [CompletionResult]::new('--notes', '--notes', [CompletionResultType]::ParameterName, 'Print each note in full, in a line of its own')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'binspace;page' {
            [CompletionResult]::new('--seed', '--seed', [CompletionResultType]::ParameterName, 'Seed of random built-in scenes and of random views')
            [CompletionResult]::new('-o', '-o', [CompletionResultType]::ParameterName, 'File to write, such as scene.html; - for standard output')
            [CompletionResult]::new('--output', '--output', [CompletionResultType]::ParameterName, 'File to write, such as scene.html; - for standard output')
            [CompletionResult]::new('--up', '--up', [CompletionResultType]::ParameterName, 'Direction that points up: auto, x, y, z, -x or X,Y,Z')
            [CompletionResult]::new('--cull', '--cull', [CompletionResultType]::ParameterName, 'Sides of polygons to leave out: none or back')
            [CompletionResult]::new('--heuristic', '--heuristic', [CompletionResultType]::ParameterName, 'How to choose the planes; `binspace stats -h` lists the ways')
            [CompletionResult]::new('--tolerance', '--tolerance', [CompletionResultType]::ParameterName, 'Distance within which points lie on a plane [default: by the input''s digits]')
            [CompletionResult]::new('--max-fragments', '--max-fragments', [CompletionResultType]::ParameterName, 'Largest number of fragments')
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'Number of threads [default: one for each processor]')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print only errors: neither notes nor progress')
            [CompletionResult]::new('--notes', '--notes', [CompletionResultType]::ParameterName, 'Print each note in full, in a line of its own')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'binspace;export' {
            [CompletionResult]::new('--seed', '--seed', [CompletionResultType]::ParameterName, 'Seed of random built-in scenes and of random views')
            [CompletionResult]::new('-o', '-o', [CompletionResultType]::ParameterName, 'File to write: .obj (and .mtl), .ply or .glb; - for standard output')
            [CompletionResult]::new('--output', '--output', [CompletionResultType]::ParameterName, 'File to write: .obj (and .mtl), .ply or .glb; - for standard output')
            [CompletionResult]::new('--format', '--format', [CompletionResultType]::ParameterName, 'Format of the file [default: by its name; obj for standard output]')
            [CompletionResult]::new('--order', '--order', [CompletionResultType]::ParameterName, 'Sort the triangles back to front for this eye')
            [CompletionResult]::new('--heuristic', '--heuristic', [CompletionResultType]::ParameterName, 'How to choose the planes; `binspace stats -h` lists the ways')
            [CompletionResult]::new('--tolerance', '--tolerance', [CompletionResultType]::ParameterName, 'Distance within which points lie on a plane [default: by the input''s digits]')
            [CompletionResult]::new('--max-fragments', '--max-fragments', [CompletionResultType]::ParameterName, 'Largest number of fragments')
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'Number of threads [default: one for each processor]')
            [CompletionResult]::new('--unwelded', '--unwelded', [CompletionResultType]::ParameterName, 'Leave out the vertices that keep closed bodies closed')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print only errors: neither notes nor progress')
            [CompletionResult]::new('--notes', '--notes', [CompletionResultType]::ParameterName, 'Print each note in full, in a line of its own')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'binspace;build' {
            [CompletionResult]::new('--seed', '--seed', [CompletionResultType]::ParameterName, 'Seed of random built-in scenes and of random views')
            [CompletionResult]::new('-o', '-o', [CompletionResultType]::ParameterName, 'File to write, such as scene.bsp, or - for standard output; with --cells, a new folder')
            [CompletionResult]::new('--output', '--output', [CompletionResultType]::ParameterName, 'File to write, such as scene.bsp, or - for standard output; with --cells, a new folder')
            [CompletionResult]::new('--cells', '--cells', [CompletionResultType]::ParameterName, 'Divide a scene too large for memory into N cells, for order, stats and render')
            [CompletionResult]::new('--heuristic', '--heuristic', [CompletionResultType]::ParameterName, 'How to choose the planes; `binspace stats -h` lists the ways')
            [CompletionResult]::new('--tolerance', '--tolerance', [CompletionResultType]::ParameterName, 'Distance within which points lie on a plane [default: by the input''s digits]')
            [CompletionResult]::new('--max-fragments', '--max-fragments', [CompletionResultType]::ParameterName, 'Largest number of fragments')
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'Number of threads [default: one for each processor]')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print only errors: neither notes nor progress')
            [CompletionResult]::new('--notes', '--notes', [CompletionResultType]::ParameterName, 'Print each note in full, in a line of its own')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'binspace;scenes' {
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'Number of threads [default: one for each processor]')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print only errors: neither notes nor progress')
            [CompletionResult]::new('--notes', '--notes', [CompletionResultType]::ParameterName, 'Print each note in full, in a line of its own')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'binspace;generate' {
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'Number of threads [default: one for each processor]')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print only errors: neither notes nor progress')
            [CompletionResult]::new('--notes', '--notes', [CompletionResultType]::ParameterName, 'Print each note in full, in a line of its own')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'binspace;help' {
            [CompletionResult]::new('demo', 'demo', [CompletionResultType]::ParameterValue, 'Draw built-in scenes, and compare every pixel with a depth buffer')
            [CompletionResult]::new('order', 'order', [CompletionResultType]::ParameterValue, 'Write a scene''s fragments in paint order, one JSON object a line')
            [CompletionResult]::new('verify', 'verify', [CompletionResultType]::ParameterValue, 'Paint a scene in order and compare every pixel with a depth buffer')
            [CompletionResult]::new('stats', 'stats', [CompletionResultType]::ParameterValue, 'Build trees of a scene and print their figures')
            [CompletionResult]::new('render', 'render', [CompletionResultType]::ParameterValue, 'Draw a scene as pixels: a PNG')
            [CompletionResult]::new('draw', 'draw', [CompletionResultType]::ParameterValue, 'Draw a view as vectors: SVG, PDF, TikZ or DXF, one path a visible polygon, or lines')
            [CompletionResult]::new('page', 'page', [CompletionResultType]::ParameterValue, 'Write a self-contained page in which people turn the scene, for a browser')
            [CompletionResult]::new('export', 'export', [CompletionResultType]::ParameterValue, 'Write a tree''s fragments as triangles, for other programs')
            [CompletionResult]::new('build', 'build', [CompletionResultType]::ParameterValue, 'Build a scene''s tree and write it to a file that every command takes as a scene')
            [CompletionResult]::new('scenes', 'scenes', [CompletionResultType]::ParameterValue, 'List the built-in scenes')
            [CompletionResult]::new('generate', 'generate', [CompletionResultType]::ParameterValue, 'Write completions of shells and manual pages into DIR')
            [CompletionResult]::new('help', 'help', [CompletionResultType]::ParameterValue, 'Print this message or the help of the given subcommand(s)')
            break
        }
        'binspace;help;demo' {
            break
        }
        'binspace;help;order' {
            break
        }
        'binspace;help;verify' {
            break
        }
        'binspace;help;stats' {
            break
        }
        'binspace;help;render' {
            break
        }
        'binspace;help;draw' {
            break
        }
        'binspace;help;page' {
            break
        }
        'binspace;help;export' {
            break
        }
        'binspace;help;build' {
            break
        }
        'binspace;help;scenes' {
            break
        }
        'binspace;help;generate' {
            break
        }
        'binspace;help;help' {
            break
        }
    })

    $completions.Where{ $_.CompletionText -like "$wordToComplete*" } |
        Sort-Object -Property ListItemText
}
