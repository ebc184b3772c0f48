//! How many pictures a second a page paints in a browser.

use std::io::Write;

use super::orders::{Eye, hash, hash_in_script};
use super::{browser, page_and_tree, said};
use crate::run::Folder;

/// How many pictures are painted to warm up, without edges and with all.
const PICTURES: [usize; 3] = [20, 60, 60];

/// Measures the processor alone: no graphics card paints. A machine's speed is printed, not judged; judged is that
/// each picture asked for is painted, that it is another one than before, and that its order is the
/// library's.
#[test]
#[ignore = "needs Chromium"]
fn pictures_a_second_at_ten_thousand_fragments() {
    let browser = browser();
    let folder = Folder::new("page_speed");
    for scene in ["city:10000", "teapot:14", "random:910"] {
        let (page, tree) = page_and_tree(&folder, scene);
        assert!((9_000..12_000).contains(&tree.len()), "{scene}: {}", tree.len());
        let script = format!(
            "[CANVAS.width, CANVAS.height] = [1280, 720];
            const picture = pictureOf(1280, 720);
            const eyes = [];
            let [painted, last] = [0, 0];
            const hash = numbers => {hash};
            const measured = count => {{
                const times = [];
                for (let i = 0; i < count; i++) {{
                    camera.yaw = i * 2 * Math.PI / count;
                    const begin = performance.now();
                    const filled = paint(TREE, camera, picture, style, TREE.fragments);
                    show(picture);
                    times.push(performance.now() - begin);
                    const now = hash(picture.pixels);
                    painted += filled > 0.5 * TREE.fragments && now !== last;
                    last = now;
                    if (i % 5 === 0) eyes.push([...viewpointOf(TREE, camera).at, hash(TREE.order)]);
                }}
                times.sort((a, b) => a - b);
                return (1000 / times[count >> 1]).toFixed(0);
            }};
            measured({});
            const plain = measured({});
            style.edges = style.cuts = [0, 0, 0];
            const speed = `${{plain}} pictures a second, with edges ${{measured({})}}`;
            return [speed, painted, eyes.map(eye => eye.join(' ')).join(',')].join(';');",
            PICTURES[0],
            PICTURES[1],
            PICTURES[2],
            hash = hash_in_script("numbers"),
        );
        let said = said(browser, &folder, &page, &script);
        let parts: Vec<&str> = said.split(';').collect();
        let [speed, painted, eyes] = parts[..] else { panic!("{said}") };
        assert_eq!(painted.parse(), Ok(PICTURES.iter().sum::<usize>()), "{scene}");
        let (mut order, mut compared) = (Vec::new(), 0);
        for eye in eyes.split(',') {
            let numbers: Vec<f64> = eye.split(' ').map(|number| number.parse().unwrap()).collect();
            let [x, y, z, found] = numbers[..] else { panic!("{eye}") };
            let Some(viewpoint) = Eye::At([x, y, z]).viewpoint(&tree) else { continue };
            tree.back_to_front_into(viewpoint, &mut order);
            assert_eq!(hash(&order), found as u32, "{scene}: {eye}");
            compared += 1;
        }
        assert!(compared > 10, "{scene}: {compared}");
        let _ = writeln!(std::io::stderr().lock(), "{scene}: {} fragments, {speed}", tree.len());
    }
}
