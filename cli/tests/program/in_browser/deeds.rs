//! The actions of people on a page.

use super::{PAINTED, PAINTERS, page_and_tree};
use crate::run::Folder;
use testkit::browser::{browser, said};

/// Performs the actions of people, and returns a line for each that went wrong.
const DEEDS: &str = "
    const wrong = [];
    const check = (name, isRight) => { if (!isRight) wrong.push(name); };
    const now = () => ({ ...camera, target: [...camera.target] });
    const key = (key, more = {}) => CANVAS.dispatchEvent(
        new KeyboardEvent('keydown', { key, bubbles: true, cancelable: true, ...more }));
    const pointer = (kind, pointerId, x, y, more = {}) => CANVAS.dispatchEvent(
        new PointerEvent('pointer' + kind, { pointerId, clientX: x, clientY: y, ...more }));
    const set = (id, value, kind = 'change') => {
        if (typeof value === 'boolean') $(id).checked = value;
        else $(id).value = value;
        $(id).dispatchEvent(new Event(kind, { bubbles: true }));
        draw(1);
        return shown();
    };
    const shown = () => {
        const image = CANVAS.getContext('2d').getImageData(0, 0, CANVAS.width, CANVAS.height);
        return new Uint32Array(image.data.buffer);
    };
    const changed = (a, b) => a.reduce((count, pixel, i) => count + (pixel !== b[i]), 0);

    let before = now();
    check('left', !key('ArrowLeft') && camera.yaw > before.yaw);
    check('up', !key('ArrowUp') && camera.pitch > before.pitch);
    check('shift', !key('ArrowRight', { shiftKey: true }) && camera.target.some((c, i) => c !== before.target[i]));
    check('plus', !key('+') && camera.distance < before.distance);
    check('minus', !key('-') && !key('-') && camera.distance > before.distance);
    check('other keys', key('x') && key('ArrowLeft', { ctrlKey: true }));
    for (let i = 0; i < 200; i++) key('ArrowDown');
    check('upright', camera.pitch === -Math.PI / 2);
    key('0');
    check('reset', JSON.stringify(now()) === JSON.stringify(before));
    pointer('down', 1, 100, 100);
    pointer('move', 1, 150, 90);
    check('drag', camera.yaw < before.yaw && camera.pitch > before.pitch);
    key('0');
    pointer('down', 2, 200, 90);
    pointer('move', 2, 300, 90);
    check('pinch', camera.yaw === before.yaw && camera.distance < before.distance);
    pointer('up', 1, 0, 0);
    pointer('cancel', 2, 0, 0);
    key('0');
    pointer('move', 1, 300, 300);
    check('released', camera.yaw === before.yaw);
    CANVAS.dispatchEvent(new WheelEvent('wheel', { deltaY: -100 }));
    check('wheel', camera.distance < before.distance);
    for (let i = 0; i < 300; i++) key('+');
    check('through', camera.distance > 0 && Math.hypot(...camera.target) > 1);
    for (let i = 0; i < 300; i++) key('-');
    check('away', camera.distance === 100);
    key('0');

    const plain = set('colours', 'material');
    const paper = plain[0];
    check('painted', changed(plain, plain.map(() => paper)) > 10000);
    for (const colours of ['polygon', 'depth', 'facing']) {
        check(colours, changed(set('colours', colours), plain) > 10000);
    }
    check('legend', $('legend').textContent.includes('front'));
    set('colours', 'material');
    check('cuts', changed(set('cuts', true), plain) > 50);
    check('edges', changed(set('edges', true), set('cuts', false)) > 50);
    check('all the same again', changed(set('edges', false), plain) === 0);
    const filled = state.filled;
    check('culling', changed(set('culling', true), plain) > 0 && state.filled < filled && state.filled > 0);
    set('culling', false);
    check('parallel', changed(set('parallel', true), plain) > 1000 && camera.isParallel);
    set('parallel', false);
    set('place', 1, 'input');
    check('first', state.filled === 1 && $('painted').textContent.startsWith('1 of '));
    check('none', changed(set('place', 0, 'input'), plain.map(() => paper)) === 0);
    key(' ');
    check('play', state.isPlaying && $('play').textContent === 'Pause');
    key(' ');
    check('pause', !state.isPlaying && $('play').textContent === 'Play');
    set('place', TREE.fragments, 'input');

    CANVAS.style.maxWidth = '300px';
    resize();
    const corner = CANVAS.getContext('2d').getImageData(0, 0, 1, 1).data;
    check('resized', CANVAS.width === 300 * devicePixelRatio && corner[0] === style.background[0]);
    CANVAS.style.maxWidth = '';
    resize();

    draw(2);
    check('smooth', graphics ? graphics.canvas.width === 2 * CANVAS.width
        : fine.width === 2 * coarse.width && fine.lineWidth === 2);
    const named = [...document.querySelectorAll('button, input, select, canvas')];
    check('named', named.length > 8 && named.every(
        one => one.ariaLabel || one.textContent && one.matches('button') || one.labels?.length > 0));
    check('figures', $('figures').textContent.includes(`fragments${TREE.fragments}`));
    return wrong.join(', ');";

#[test]
#[ignore = "needs Chromium"]
fn people_can_turn_it_by_mouse_touch_and_keys() {
    let browser = browser();
    let folder = Folder::new("page_deeds");
    let (page, _) = page_and_tree(&folder, "random:60");
    for painter in PAINTERS {
        let script = format!("graphics = {painter}; {DEEDS}");
        assert_eq!(said(browser, &folder.path(""), &page, &script), "", "{painter}");
    }
}

#[test]
#[ignore = "needs Chromium"]
fn translucent_polygons_show_what_is_behind_them() {
    let browser = browser();
    let folder = Folder::new("page_translucent");
    folder.write("m.mtl", "newmtl blue\nKd 0 0 1\nnewmtl red\nKd 1 0 0\nd 0.25\n");
    let square = |z: i32| format!("v -9 -9 {z}\nv 9 -9 {z}\nv 9 9 {z}\nv -9 9 {z}\n");
    let faces = "usemtl blue\nf 1 2 3 4\nusemtl red\nf 5 6 7 8\n";
    folder.write("s.obj", format!("mtllib m.mtl\n{}{}{faces}", square(0), square(4)));
    let (page, _) = page_and_tree(&folder, "s.obj");
    let script = "const middle = z => {
            camera = { base: [[0, 0, -z], [z, 0, 0], [0, 1, 0]], yaw: 0, pitch: 0, target: [0, 0, 0],
                distance: 3, slope: 0.1, isParallel: true };
            style.isShaded = false;
            const pixel = painted(9, 9, style)[40];
            return [0, 8, 16].map(shift => (pixel >> shift) & 255);
        };
        return [...middle(1), ...middle(-1)].join(' ');";
    for painter in PAINTERS {
        let script = format!("graphics = {painter}; {PAINTED} {script}");
        assert_eq!(
            said(browser, &folder.path(""), &page, &script),
            "64 0 191 0 0 255",
            "{painter}"
        );
    }
}
