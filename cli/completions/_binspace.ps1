
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
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'Number of threads [default: one per processor]')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print errors only: no notes, no progress')
            [CompletionResult]::new('--notes', '--notes', [CompletionResultType]::ParameterName, 'Print each note in full, on its own line')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('-V', '-V ', [CompletionResultType]::ParameterName, 'Print version')
            [CompletionResult]::new('--version', '--version', [CompletionResultType]::ParameterName, 'Print version')
            [CompletionResult]::new('demo', 'demo', [CompletionResultType]::ParameterValue, 'Draw built-in scenes and compare every pixel with a depth buffer')
            [CompletionResult]::new('order', 'order', [CompletionResultType]::ParameterValue, 'Write a scene''s fragments in painting order, one JSON object per line')
            [CompletionResult]::new('verify', 'verify', [CompletionResultType]::ParameterValue, 'Paint a scene in order and compare every pixel with a depth buffer')
            [CompletionResult]::new('stats', 'stats', [CompletionResultType]::ParameterValue, 'Build trees of a scene and print their sizes and times')
            [CompletionResult]::new('render', 'render', [CompletionResultType]::ParameterValue, 'Draw a scene as pixels, in a PNG')
            [CompletionResult]::new('draw', 'draw', [CompletionResultType]::ParameterValue, 'Draw a scene as vectors (SVG, PDF, TikZ, DXF): one path per visible polygon, or lines')
            [CompletionResult]::new('page', 'page', [CompletionResultType]::ParameterValue, 'Write a page for a browser, in which readers turn the scene')
            [CompletionResult]::new('export', 'export', [CompletionResultType]::ParameterValue, 'Write a tree''s fragments as triangles, for other programs')
            [CompletionResult]::new('build', 'build', [CompletionResultType]::ParameterValue, 'Build a scene''s tree and store both in a file that every command accepts as SCENE')
            [CompletionResult]::new('scenes', 'scenes', [CompletionResultType]::ParameterValue, 'List the built-in scenes')
            [CompletionResult]::new('generate', 'generate', [CompletionResultType]::ParameterValue, 'Write shell completions and manual pages into DIR')
            [CompletionResult]::new('help', 'help', [CompletionResultType]::ParameterValue, 'Print this message or the help of the given subcommand(s)')
            break
        }
        'binspace;demo' {
            [CompletionResult]::new('-o', '-o', [CompletionResultType]::ParameterName, 'Folder for the pictures; created if it is missing')
            [CompletionResult]::new('--output', '--output', [CompletionResultType]::ParameterName, 'Folder for the pictures; created if it is missing')
            [CompletionResult]::new('--views', '--views', [CompletionResultType]::ParameterName, 'Number of views to compare, around each scene and inside it')
            [CompletionResult]::new('--size', '--size', [CompletionResultType]::ParameterName, 'Size of the pictures in pixels')
            [CompletionResult]::new('--seed', '--seed', [CompletionResultType]::ParameterName, 'Seed of random scenes and views')
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'Number of threads [default: one per processor]')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print errors only: no notes, no progress')
            [CompletionResult]::new('--notes', '--notes', [CompletionResultType]::ParameterName, 'Print each note in full, on its own line')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'binspace;order' {
            [CompletionResult]::new('--seed', '--seed', [CompletionResultType]::ParameterName, 'Seed of random built-in scenes and of random views')
            [CompletionResult]::new('--eye', '--eye', [CompletionResultType]::ParameterName, 'Position of the eye; repeat the option for more eyes')
            [CompletionResult]::new('--direction', '--direction', [CompletionResultType]::ParameterName, 'Direction of view, for an eye infinitely far away')
            [CompletionResult]::new('--cull', '--cull', [CompletionResultType]::ParameterName, 'Sides of polygons to omit: none or back')
            [CompletionResult]::new('-o', '-o', [CompletionResultType]::ParameterName, 'File to write; - for standard output')
            [CompletionResult]::new('--output', '--output', [CompletionResultType]::ParameterName, 'File to write; - for standard output')
            [CompletionResult]::new('--heuristic', '--heuristic', [CompletionResultType]::ParameterName, 'Heuristic to choose splitting planes: see `binspace stats -h`')
            [CompletionResult]::new('--tolerance', '--tolerance', [CompletionResultType]::ParameterName, 'Points this close to a plane lie on it [default: by the input''s precision]')
            [CompletionResult]::new('--max-fragments', '--max-fragments', [CompletionResultType]::ParameterName, 'Stop with an error if the tree needs more fragments')
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'Number of threads [default: one per processor]')
            [CompletionResult]::new('--front-to-back', '--front-to-back', [CompletionResultType]::ParameterName, 'List the nearest fragment first')
            [CompletionResult]::new('--edges', '--edges', [CompletionResultType]::ParameterName, 'Add the number of the polygon''s edge on which each edge lies')
            [CompletionResult]::new('--weights', '--weights', [CompletionResultType]::ParameterName, 'Add weights of the polygon''s corners for each vertex, to interpolate attributes')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print errors only: no notes, no progress')
            [CompletionResult]::new('--notes', '--notes', [CompletionResultType]::ParameterName, 'Print each note in full, on its own line')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'binspace;verify' {
            [CompletionResult]::new('--seed', '--seed', [CompletionResultType]::ParameterName, 'Seed of random built-in scenes and of random views')
            [CompletionResult]::new('--views', '--views', [CompletionResultType]::ParameterName, 'Number of views to compare, alternately around the scene and inside it')
            [CompletionResult]::new('--size', '--size', [CompletionResultType]::ParameterName, 'Size of the pictures in pixels')
            [CompletionResult]::new('--up', '--up', [CompletionResultType]::ParameterName, 'Direction that points up: auto, x, y, z, -x or X,Y,Z')
            [CompletionResult]::new('--cull', '--cull', [CompletionResultType]::ParameterName, 'Sides of polygons to omit: none or back')
            [CompletionResult]::new('--heuristic', '--heuristic', [CompletionResultType]::ParameterName, 'Heuristic to choose splitting planes: see `binspace stats -h`')
            [CompletionResult]::new('--tolerance', '--tolerance', [CompletionResultType]::ParameterName, 'Points this close to a plane lie on it [default: by the input''s precision]')
            [CompletionResult]::new('--max-fragments', '--max-fragments', [CompletionResultType]::ParameterName, 'Stop with an error if the tree needs more fragments')
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'Number of threads [default: one per processor]')
            [CompletionResult]::new('--json', '--json', [CompletionResultType]::ParameterName, 'Print a JSON object for each view and one for the total')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print errors only: no notes, no progress')
            [CompletionResult]::new('--notes', '--notes', [CompletionResultType]::ParameterName, 'Print each note in full, on its own line')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'binspace;stats' {
            [CompletionResult]::new('--seed', '--seed', [CompletionResultType]::ParameterName, 'Seed of random built-in scenes and of random views')
            [CompletionResult]::new('--heuristic', '--heuristic', [CompletionResultType]::ParameterName, 'Heuristic to choose splitting planes: a name from below, or all')
            [CompletionResult]::new('--tolerance', '--tolerance', [CompletionResultType]::ParameterName, 'Points this close to a plane lie on it [default: by the input''s precision]')
            [CompletionResult]::new('--max-fragments', '--max-fragments', [CompletionResultType]::ParameterName, 'Stop with an error if the tree needs more fragments')
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'Number of threads [default: one per processor]')
            [CompletionResult]::new('--json', '--json', [CompletionResultType]::ParameterName, 'Print a JSON object for each tree')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print errors only: no notes, no progress')
            [CompletionResult]::new('--notes', '--notes', [CompletionResultType]::ParameterName, 'Print each note in full, on its own line')
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
            [CompletionResult]::new('--target', '--target', [CompletionResultType]::ParameterName, 'Point at the centre of the picture [default: the scene''s centre]')
            [CompletionResult]::new('--up', '--up', [CompletionResultType]::ParameterName, 'Direction that points up: auto, x, y, z, -x or X,Y,Z')
            [CompletionResult]::new('--fov', '--fov', [CompletionResultType]::ParameterName, 'Vertical field of view in degrees')
            [CompletionResult]::new('--size', '--size', [CompletionResultType]::ParameterName, 'Size of the picture in pixels')
            [CompletionResult]::new('--margin', '--margin', [CompletionResultType]::ParameterName, 'Empty border around a whole scene, in percent of the picture on each side')
            [CompletionResult]::new('--colours', '--colours', [CompletionResultType]::ParameterName, 'Colour by material or by polygon')
            [CompletionResult]::new('--cull', '--cull', [CompletionResultType]::ParameterName, 'Sides of polygons to omit: none or back')
            [CompletionResult]::new('--samples', '--samples', [CompletionResultType]::ParameterName, 'Antialias: N x N samples per pixel')
            [CompletionResult]::new('--depth', '--depth', [CompletionResultType]::ParameterName, 'Draw depths: near is bright; with --depth=far, far is bright')
            [CompletionResult]::new('--heuristic', '--heuristic', [CompletionResultType]::ParameterName, 'Heuristic to choose splitting planes: see `binspace stats -h`')
            [CompletionResult]::new('--tolerance', '--tolerance', [CompletionResultType]::ParameterName, 'Points this close to a plane lie on it [default: by the input''s precision]')
            [CompletionResult]::new('--max-fragments', '--max-fragments', [CompletionResultType]::ParameterName, 'Stop with an error if the tree needs more fragments')
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'Number of threads [default: one per processor]')
            [CompletionResult]::new('--z-buffer', '--z-buffer', [CompletionResultType]::ParameterName, 'Draw with a depth buffer')
            [CompletionResult]::new('--difference', '--difference', [CompletionResultType]::ParameterName, 'Draw where painter and depth buffer differ; exit status 1 if they do')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print errors only: no notes, no progress')
            [CompletionResult]::new('--notes', '--notes', [CompletionResultType]::ParameterName, 'Print each note in full, on its own line')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'binspace;draw' {
            [CompletionResult]::new('--seed', '--seed', [CompletionResultType]::ParameterName, 'Seed of random built-in scenes and of random views')
            [CompletionResult]::new('-o', '-o', [CompletionResultType]::ParameterName, 'File to write: .svg, .pdf, .tex, .dxf or .png; - for standard output')
            [CompletionResult]::new('--output', '--output', [CompletionResultType]::ParameterName, 'File to write: .svg, .pdf, .tex, .dxf or .png; - for standard output')
            [CompletionResult]::new('--format', '--format', [CompletionResultType]::ParameterName, 'File format [default: by the file''s name; svg for standard output]')
            [CompletionResult]::new('--eye', '--eye', [CompletionResultType]::ParameterName, 'Position of the eye')
            [CompletionResult]::new('--direction', '--direction', [CompletionResultType]::ParameterName, 'Direction of view of a parallel projection')
            [CompletionResult]::new('--view', '--view', [CompletionResultType]::ParameterName, 'Parallel view by name: front, top, right or iso')
            [CompletionResult]::new('--target', '--target', [CompletionResultType]::ParameterName, 'Point at the centre of the picture [default: the scene''s centre]')
            [CompletionResult]::new('--up', '--up', [CompletionResultType]::ParameterName, 'Direction that points up: auto, x, y, z, -x or X,Y,Z')
            [CompletionResult]::new('--fov', '--fov', [CompletionResultType]::ParameterName, 'Vertical field of view in degrees')
            [CompletionResult]::new('--size', '--size', [CompletionResultType]::ParameterName, 'Size of the picture in pixels')
            [CompletionResult]::new('--margin', '--margin', [CompletionResultType]::ParameterName, 'Empty border around a whole scene, in percent of the picture on each side')
            [CompletionResult]::new('--scale', '--scale', [CompletionResultType]::ParameterName, 'Millimetres of paper per unit of the scene; needs --view or --direction')
            [CompletionResult]::new('--edges', '--edges', [CompletionResultType]::ParameterName, 'Edges to draw: none, all, creases[=DEG] or silhouettes [default: none; creases with --lines, --hidden or a DXF]')
            [CompletionResult]::new('--hidden', '--hidden', [CompletionResultType]::ParameterName, 'Hidden edges: none, dashed or layers (dashed by depth)')
            [CompletionResult]::new('--line-width', '--line-width', [CompletionResultType]::ParameterName, 'Width of lines in pixels')
            [CompletionResult]::new('--colours', '--colours', [CompletionResultType]::ParameterName, 'Colour by material or by polygon')
            [CompletionResult]::new('--cull', '--cull', [CompletionResultType]::ParameterName, 'Sides of polygons to omit: none or back')
            [CompletionResult]::new('--background', '--background', [CompletionResultType]::ParameterName, 'Colour behind the scene, such as #ffeecc, or none')
            [CompletionResult]::new('--seams', '--seams', [CompletionResultType]::ParameterName, 'How to avoid light seams between adjacent polygons')
            [CompletionResult]::new('--min-size', '--min-size', [CompletionResultType]::ParameterName, 'Omit polygons with less visible area than PX x PX pixels, and lines shorter than PX [default: 0.01; 0 in a PNG]')
            [CompletionResult]::new('--heuristic', '--heuristic', [CompletionResultType]::ParameterName, 'Heuristic to choose splitting planes: see `binspace stats -h`')
            [CompletionResult]::new('--tolerance', '--tolerance', [CompletionResultType]::ParameterName, 'Points this close to a plane lie on it [default: by the input''s precision]')
            [CompletionResult]::new('--max-fragments', '--max-fragments', [CompletionResultType]::ParameterName, 'Stop with an error if the tree needs more fragments')
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'Number of threads [default: one per processor]')
            [CompletionResult]::new('--ids', '--ids', [CompletionResultType]::ParameterName, 'Write polygon numbers, edge numbers and material names into the SVG')
            [CompletionResult]::new('--json', '--json', [CompletionResultType]::ParameterName, 'Print statistics of the drawing as a JSON object')
            [CompletionResult]::new('--lines', '--lines', [CompletionResultType]::ParameterName, 'Draw only lines; polygons still hide the lines behind them')
            [CompletionResult]::new('--opaque', '--opaque', [CompletionResultType]::ParameterName, 'Ignore opacities: draw all polygons as opaque')
            [CompletionResult]::new('--translucent', '--translucent', [CompletionResultType]::ParameterName, 'Draw hidden polygons too, under the polygons in front of them')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print errors only: no notes, no progress')
            [CompletionResult]::new('--notes', '--notes', [CompletionResultType]::ParameterName, 'Print each note in full, on its own line')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'binspace;page' {
            [CompletionResult]::new('--seed', '--seed', [CompletionResultType]::ParameterName, 'Seed of random built-in scenes and of random views')
            [CompletionResult]::new('-o', '-o', [CompletionResultType]::ParameterName, 'File to write, such as scene.html; - for standard output')
            [CompletionResult]::new('--output', '--output', [CompletionResultType]::ParameterName, 'File to write, such as scene.html; - for standard output')
            [CompletionResult]::new('--up', '--up', [CompletionResultType]::ParameterName, 'Direction that points up: auto, x, y, z, -x or X,Y,Z')
            [CompletionResult]::new('--cull', '--cull', [CompletionResultType]::ParameterName, 'Sides of polygons to omit: none or back')
            [CompletionResult]::new('--heuristic', '--heuristic', [CompletionResultType]::ParameterName, 'Heuristic to choose splitting planes: see `binspace stats -h`')
            [CompletionResult]::new('--tolerance', '--tolerance', [CompletionResultType]::ParameterName, 'Points this close to a plane lie on it [default: by the input''s precision]')
            [CompletionResult]::new('--max-fragments', '--max-fragments', [CompletionResultType]::ParameterName, 'Stop with an error if the tree needs more fragments')
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'Number of threads [default: one per processor]')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print errors only: no notes, no progress')
            [CompletionResult]::new('--notes', '--notes', [CompletionResultType]::ParameterName, 'Print each note in full, on its own line')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'binspace;export' {
            [CompletionResult]::new('--seed', '--seed', [CompletionResultType]::ParameterName, 'Seed of random built-in scenes and of random views')
            [CompletionResult]::new('-o', '-o', [CompletionResultType]::ParameterName, 'File to write: .obj (and .mtl), .ply or .glb; - for standard output')
            [CompletionResult]::new('--output', '--output', [CompletionResultType]::ParameterName, 'File to write: .obj (and .mtl), .ply or .glb; - for standard output')
            [CompletionResult]::new('--format', '--format', [CompletionResultType]::ParameterName, 'File format [default: by the file''s name; obj for standard output]')
            [CompletionResult]::new('--order', '--order', [CompletionResultType]::ParameterName, 'Sort the triangles back to front for this eye')
            [CompletionResult]::new('--heuristic', '--heuristic', [CompletionResultType]::ParameterName, 'Heuristic to choose splitting planes: see `binspace stats -h`')
            [CompletionResult]::new('--tolerance', '--tolerance', [CompletionResultType]::ParameterName, 'Points this close to a plane lie on it [default: by the input''s precision]')
            [CompletionResult]::new('--max-fragments', '--max-fragments', [CompletionResultType]::ParameterName, 'Stop with an error if the tree needs more fragments')
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'Number of threads [default: one per processor]')
            [CompletionResult]::new('--unwelded', '--unwelded', [CompletionResultType]::ParameterName, 'Leave T-junctions between fragments open: fewer triangles, but cracks')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print errors only: no notes, no progress')
            [CompletionResult]::new('--notes', '--notes', [CompletionResultType]::ParameterName, 'Print each note in full, on its own line')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'binspace;build' {
            [CompletionResult]::new('--seed', '--seed', [CompletionResultType]::ParameterName, 'Seed of random built-in scenes and of random views')
            [CompletionResult]::new('-o', '-o', [CompletionResultType]::ParameterName, 'File to write, such as scene.bsp; - for standard output; with --cells, a new folder')
            [CompletionResult]::new('--output', '--output', [CompletionResultType]::ParameterName, 'File to write, such as scene.bsp; - for standard output; with --cells, a new folder')
            [CompletionResult]::new('--cells', '--cells', [CompletionResultType]::ParameterName, 'Divide a scene larger than memory into N cells; order, stats and render accept the folder')
            [CompletionResult]::new('--heuristic', '--heuristic', [CompletionResultType]::ParameterName, 'Heuristic to choose splitting planes: see `binspace stats -h`')
            [CompletionResult]::new('--tolerance', '--tolerance', [CompletionResultType]::ParameterName, 'Points this close to a plane lie on it [default: by the input''s precision]')
            [CompletionResult]::new('--max-fragments', '--max-fragments', [CompletionResultType]::ParameterName, 'Stop with an error if the tree needs more fragments')
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'Number of threads [default: one per processor]')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print errors only: no notes, no progress')
            [CompletionResult]::new('--notes', '--notes', [CompletionResultType]::ParameterName, 'Print each note in full, on its own line')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'binspace;scenes' {
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'Number of threads [default: one per processor]')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print errors only: no notes, no progress')
            [CompletionResult]::new('--notes', '--notes', [CompletionResultType]::ParameterName, 'Print each note in full, on its own line')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'binspace;generate' {
            [CompletionResult]::new('--threads', '--threads', [CompletionResultType]::ParameterName, 'Number of threads [default: one per processor]')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print errors only: no notes, no progress')
            [CompletionResult]::new('--notes', '--notes', [CompletionResultType]::ParameterName, 'Print each note in full, on its own line')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'binspace;help' {
            [CompletionResult]::new('demo', 'demo', [CompletionResultType]::ParameterValue, 'Draw built-in scenes and compare every pixel with a depth buffer')
            [CompletionResult]::new('order', 'order', [CompletionResultType]::ParameterValue, 'Write a scene''s fragments in painting order, one JSON object per line')
            [CompletionResult]::new('verify', 'verify', [CompletionResultType]::ParameterValue, 'Paint a scene in order and compare every pixel with a depth buffer')
            [CompletionResult]::new('stats', 'stats', [CompletionResultType]::ParameterValue, 'Build trees of a scene and print their sizes and times')
            [CompletionResult]::new('render', 'render', [CompletionResultType]::ParameterValue, 'Draw a scene as pixels, in a PNG')
            [CompletionResult]::new('draw', 'draw', [CompletionResultType]::ParameterValue, 'Draw a scene as vectors (SVG, PDF, TikZ, DXF): one path per visible polygon, or lines')
            [CompletionResult]::new('page', 'page', [CompletionResultType]::ParameterValue, 'Write a page for a browser, in which readers turn the scene')
            [CompletionResult]::new('export', 'export', [CompletionResultType]::ParameterValue, 'Write a tree''s fragments as triangles, for other programs')
            [CompletionResult]::new('build', 'build', [CompletionResultType]::ParameterValue, 'Build a scene''s tree and store both in a file that every command accepts as SCENE')
            [CompletionResult]::new('scenes', 'scenes', [CompletionResultType]::ParameterValue, 'List the built-in scenes')
            [CompletionResult]::new('generate', 'generate', [CompletionResultType]::ParameterValue, 'Write shell completions and manual pages into DIR')
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
