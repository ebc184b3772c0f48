//! The script of a page decompresses what miniz compresses.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use miniz_oxide::deflate::compress_to_vec;

use super::page_and_tree;
use crate::run::Folder;
use testkit::browser::{browser, hash, hash_in_script, said};
use testkit::dice::Dice;

#[test]
#[ignore = "needs Chromium"]
fn bytes_come_back() {
    let folder = Folder::new("page_inflated");
    let (page, _) = page_and_tree(&folder, "newell");
    let mut dice = Dice(7);
    let (mut arguments, mut expected) = (Vec::new(), Vec::new());
    for k in 0..300_u64 {
        // From all alike to all different, and some longer than any copy reaches.
        let (count, kinds) =
            (dice.roll() % if k % 50 == 49 { 100_000 } else { 2_000 }, k % 256 + 1);
        let mut bytes: Vec<u8> = (0..count).map(|_| (dice.roll() % kinds) as u8).collect();
        bytes.extend_from_within(..bytes.len() / 3);
        let packed = STANDARD.encode(compress_to_vec(&bytes, (k % 11) as u8));
        arguments.push(format!("[\"{packed}\", {}]", bytes.len()));
        expected.push(hash(&bytes.iter().map(|&byte| byte.into()).collect::<Vec<u32>>()));
    }
    let script = format!(
        "return [{}].map(([text, count]) => {{
            const bytes = inflated(Uint8Array.from(atob(text), c => c.charCodeAt(0)), count);
            return {};
        }}).join(' ');",
        arguments.join(","),
        hash_in_script("bytes"),
    );
    let said = said(browser(), &folder.path(""), &page, &script);
    let found = said.split(' ').map(|hash| hash.parse::<u32>().unwrap());
    assert!(found.eq(expected));
}
