# What .ci/run and .ci/nightly share: steps and their table, installing, and the parts of .ci/nightly.
# This file is sourced, from the root of the repository.

set -uo pipefail

target=$(realpath -m "${CARGO_TARGET_DIR:-target}")
# Workspaces compile into one folder, with the flags of a plain `cargo test`: what they share is compiled once.
export CARGO_TARGET_DIR=$target
export CARGO_TERM_PROGRESS_WHEN=never
# A fresh clone gains nothing from what incremental builds keep.
export CARGO_INCREMENTAL=0
rust_version=$(sed -n 's/^rust-version = "\(.*\)"/\1/p' Cargo.toml)
logs=$target/ci
mkdir -p "$logs"

if [ -d ../shared/scenes ]; then
    BINSPACE_SCENES=$(cd ../shared/scenes && pwd)
    export BINSPACE_SCENES
fi

# --- Steps ---

# Steps that run beside others write to the same files.
rm -f "$logs"/{rows,failed,skipped,settled}
touch "$logs"/{rows,failed,skipped,settled}

# step NAME GUARDS COMMAND…: runs a command, and notes its seconds and whether it failed.
step() {
    local name=$1 guards=$2 begin=$SECONDS result=passed
    shift 2
    echo "── $name: $*"
    "$@" || { result=FAILED && echo "$name" >>"$logs/failed"; }
    echo "── $name: $result after $((SECONDS - begin)) s"
    echo "$((SECONDS - begin))|$result|$name|$guards" >>"$logs/rows"
    [ "$result" = passed ]
}

# beside NAME: begins a function of steps, which runs beside the steps that follow. It has a process group of its own,
# which ends with this script.
beside() {
    set -m
    "$1" >"$logs/$1.log" 2>&1 </dev/null &
    set +m
    printf -v "beside_$1" %s $!
}
trap 'for job in $(jobs -p); do kill -- "-$job" 2>/dev/null; done' EXIT

# joined NAME: waits for a function of `beside`, and shows what it has written. One that ended before its last step has
# failed.
joined() {
    local pid=beside_$1
    wait "${!pid}" || echo "$1" >>"$logs/failed"
    cat "$logs/$1.log"
}

# skip NAME REASON: notes a step that does not run.
skip() {
    echo "── $1: skipped: $2"
    echo "$1: $2" >>"$logs/skipped"
}

# Notes the parts that passed, prints the table of all steps, and exits with 1 if one failed.
finish() {
    local name seconds result guards
    while read -r name; do
        record "$name"
    done <"$logs/settled"
    echo
    printf '%7s  %-6s  %-38s  %s\n' seconds result step guards
    while IFS='|' read -r seconds result name guards; do
        printf '%7s  %-6s  %-38s  %s\n' "$seconds" "$result" "$name" "$guards"
    done <"$logs/rows"
    echo
    sed 's/^/skipped: /' "$logs/skipped"
    if [ -s "$logs/failed" ]; then
        echo "FAILED in $SECONDS s: $(paste -sd ';' "$logs/failed")"
        exit 1
    fi
    echo "ALL PASSED in $SECONDS s"
}

# --- Installing ---

has_browser() {
    local name
    for name in chromium chromium-browser google-chrome-stable google-chrome; do
        "$name" --version >/dev/null 2>&1 && return
    done
    return 1
}

# Other MPIs have other options to start ranks; libclang makes the bindings.
has_mpi() {
    [[ $(mpirun --version 2>/dev/null) == *"Open MPI"* ]] && mpicc --version >/dev/null 2>&1 && {
        [ -n "${LIBCLANG_PATH:-}" ] || ldconfig -p | grep -q libclang ||
            ls /usr/lib/llvm*/lib/libclang*.so* >/dev/null 2>&1
    }
}

# A driver that wgpu draws with.
has_vulkan() {
    compgen -G "/usr/share/vulkan/icd.d/*.json" >/dev/null || compgen -G "/etc/vulkan/icd.d/*.json" >/dev/null
}

has_oldest() { cargo "+$rust_version" --version >/dev/null 2>&1; }

# The standard library for a target of 32 bits.
has_32_bits() { [ -d "$(rustc --print sysroot)/lib/rustlib/i686-unknown-linux-gnu/lib" ]; }

# A linker and a machine that make and run programs of 32 bits.
runs_32_bits() {
    cc -m32 -x c -o "$logs/32-bits" - <<<"int main(void) { return 0; }" 2>/dev/null && "$logs/32-bits"
}

has_nightly() { cargo +nightly --version >/dev/null 2>&1; }

has_cargo_fuzz() { has_nightly && cargo fuzz --version >/dev/null 2>&1; }

has_scenes() { [ -n "${BINSPACE_SCENES:-}" ]; }

# What has to be there for a part of .ci/nightly or for its cheapest form, one check a word.
needs() {
    case $1 in
    bits_32) echo has_32_bits runs_32_bits ;;
    bits_32_cheaply) echo has_32_bits ;;
    browser*) echo has_browser ;;
    fuzzing) echo has_cargo_fuzz ;;
    gpu) echo has_vulkan ;;
    mpi*) echo has_mpi ;;
    oldest*) echo has_oldest ;;
    scenes*) echo has_scenes ;;
    esac
}

# missing NAME: the first thing that a part or its cheapest form needs and that is not there.
missing() {
    local check
    for check in $(needs "$1"); do
        "$check" || { echo "$check"; return; }
    done
}

# Installs what the named checks do not find. A machine of CI is there for it; others are left as they are.
install() {
    local check packages=() status=0
    for check in "$@"; do
        "$check" && continue
        case $check in
        has_browser) packages+=(chromium) ;;
        has_mpi) packages+=(openmpi-bin libopenmpi-dev libclang-dev) ;;
        has_vulkan) packages+=(mesa-vulkan-drivers) ;;
        runs_32_bits) packages+=(libc6-dev-i386 "lib32gcc-$(gcc -dumpversion)-dev") ;;
        has_oldest)
            logged rustup toolchain install "$rust_version" --profile minimal --no-self-update || status=1
            ;;
        has_32_bits) logged rustup target add i686-unknown-linux-gnu || status=1 ;;
        has_cargo_fuzz) logged cargo install cargo-fuzz --locked || status=1 ;;
        esac
    done
    if [ ${#packages[@]} -gt 0 ]; then
        logged apt-get update && logged apt-get install --yes --no-install-recommends "${packages[@]}" || status=1
    fi
    return "$status"
}

# Runs a command that downloads, and shows its output only if it fails.
logged() {
    echo "installing: $*"
    local log=$logs/install-$BASHPID.log
    timeout 600 "$@" >"$log" 2>&1 && return
    echo "failed: $*"
    tail -n 40 "$log"
    return 1
}

# What is missing does not fail: the steps that need it are skipped and named.
installing() {
    [ "${CI:-}" = true ] || { echo "nothing is installed without CI=true"; return; }
    install "$@" || echo "some of it could not be installed"
}

# --- The parts of .ci/nightly ---
# Each part has a function that runs it, and for .ci/run the paths that it guards and a function `PART_cheaply`. Without
# one, `cargo test` and the lints are the cheapest form.

parts=(long_tests scenes report browser bits_32 mpi gpu oldest old_matplotlib)

guards() {
    case $1 in
    long_tests) echo "orders of large scenes, culled walks; the long tests of evidence and lecture" ;;
    scenes) echo "real scenes: files read, closed meshes, hits, every pixel" ;;
    report) echo "no method called exact errs in any family of hard scenes; evidence and lecture" ;;
    browser) echo "pages that turn a scene, in Chromium" ;;
    bits_32) echo "sizes and numbers where usize has 32 bits" ;;
    mpi) echo "pictures and errors on 1 to 8 MPI ranks" ;;
    gpu) echo "the example with wgpu, pixel by pixel" ;;
    oldest) echo "Rust $rust_version, which the packages promise" ;;
    old_matplotlib) echo "matplotlib 3.8 and numpy 1, with the wheel that users get" ;;
    fuzzing) echo "inputs that nobody has tried" ;;
    effort) echo "ten times as many scenes, rays and cases" ;;
    demo) echo "the first command of the README" ;;
    esac
}

# A change of one of these paths makes .ci/run call the whole part.
paths() {
    case $1 in
    long_tests)
        echo src/exact src/faces src/build src/tree src/overlay src/raster src/scene crates/evidence crates/lab \
            tests/large tests/overlay tests/mesh/closed.rs crates/testkit/src/{judge,rays}.rs
        ;;
    scenes)
        echo src/exact src/faces src/build src/tree src/query src/raster src/scene src/verify src/view src/paint.rs \
            tests/{query,obj}/real_scenes.rs tests/mesh/closed.rs cli/tests/program/real_scenes.rs \
            cli/src/commands/verify.rs crates/testkit/src/real_scenes.rs
        ;;
    report) echo src crates Cargo.toml Cargo.lock ;;
    browser)
        echo cli/src/page cli/src/commands/page.rs cli/src/samples.rs cli/tests/program/in_browser \
            crates/testkit/src/browser.rs src/exact/eye.rs src/tree/order
        ;;
    bits_32)
        echo src/exact src/bits.rs src/memory.rs src/save.rs src/{tree,scene,partition}/saved* src/tree/parts.rs \
            src/tree/node.rs src/tree/bounds.rs src/tree/order src/drawing/{lines,quadtree}.rs src/layers tests/alone
        ;;
    mpi)
        echo distributed Cargo.toml src/partition src/save.rs src/tree/saved src/tree/saved.rs src/raster src/scene/obj.rs
        ;;
    gpu) echo gpu Cargo.toml src/tree/mesh src/tree/mesh.rs src/tree/order src/raster ;;
    oldest) git ls-files '*Cargo.toml' '*Cargo.lock' ;;
    old_matplotlib) echo python ;;
    esac
}

# The tests that take longer. `BINSPACE_EFFORT` is their number of scenes.
long_tests() {
    cargo test -- --ignored --skip real_scenes --skip in_browser --skip out_of_memory::one_case && evidence --ignored
}

# evidence OPTION…: the tests of what the library is compared with, and of the lecture.
evidence() { cargo test -p binspace-evidence -p binspace-lab -- "$@"; }

# Tests of real scenes, and every pixel of them from some views. The program of `cargo test` is fast enough.
scenes() {
    cargo test real_scenes -- --ignored || return 1
    verify_scenes "$BINSPACE_SCENES"/*.obj
}
scenes_cheaply() { verify_scenes "$BINSPACE_SCENES"/{cornell_box,doom_e1m1,teapot_quads_2k}.obj; }

# Each scene is painted by one thread, two scenes at a time; any wrong pixel is a failure.
verify_scenes() {
    export -f verify_scene
    printf '%s\0' "$@" | xargs -0 -P 2 -I SCENE bash -c 'verify_scene SCENE'
}
# A scene from 8 views at 640×480, the largest from 2.
verify_scene() {
    local views=8 lines
    case $1 in
    */maple_tree* | */showroom*) views=2 ;;
    esac
    lines=$("$CARGO_TARGET_DIR/debug/binspace" verify "$1" --views "$views" --threads 1 2>/dev/null) || {
        echo "$1: wrong"
        return 1
    }
    echo "$(basename "$1"): ${lines##*$'\n'}"
}

# The program is the one that the tests have built.
report() { evidence && "$CARGO_TARGET_DIR/debug/binspace-lab" report --quick -o "$logs/report"; }

browser() { cargo test --test program in_browser -- --ignored; }
browser_cheaply() { cargo test --test program in_browser::deeds -- --ignored; }

# With all features except `validate`, which is slow.
bits_32() {
    cargo test --locked --manifest-path tests/alone/Cargo.toml --target i686-unknown-linux-gnu \
        --no-default-features --features "drawing layers mint obj parallel pdf raster save scene"
}
bits_32_cheaply() { cargo check -p binspace --all-features --target i686-unknown-linux-gnu; }

# Scenes spread over MPI ranks: a workspace of its own.
mpi() {
    cargo clippy --locked --manifest-path distributed/Cargo.toml --all-targets -- -D warnings &&
        cargo test --locked --manifest-path distributed/Cargo.toml -- --include-ignored \
            --skip one_rank_of_several_panics
}
# Two ranks, one scene. Without optimization, compiling takes a third of the time.
mpi_cheaply() {
    CARGO_PROFILE_DEV_OPT_LEVEL=0 cargo test --locked --manifest-path distributed/Cargo.toml --test mpirun -- \
        --ignored two_ranks
}

# The example with wgpu: a workspace of its own.
gpu() { cargo test --locked --manifest-path gpu/Cargo.toml -- --include-ignored; }
gpu_cheaply() { cargo check --locked --manifest-path gpu/Cargo.toml --all-targets; }

# The library and the programs by the oldest compiler that they promise to work with.
oldest() {
    local manifest
    for manifest in distributed/Cargo.toml gpu/Cargo.toml python/Cargo.toml; do
        grep -qx "rust-version = \"$rust_version\"" "$manifest" ||
            { echo "$manifest promises another Rust version"; return 1; }
    done
    cargo "+$rust_version" check --workspace --locked
}
oldest_cheaply() { cargo "+$rust_version" check --locked -p binspace --all-features; }

# An environment for Python packages, and in it what is named, installed only where it is missing.
python_environment() {
    local folder=$target/python/$1
    shift
    [ -x "$folder/bin/pip" ] || python3 -m venv "$folder" || return 1
    logged "$folder/bin/pip" install --no-compile "$@"
}

# python_wheel OPTION…: the wheel of the Python package. Without `--release` it is compiled faster. In a folder of its
# own, Cargo does not let it wait for other steps.
python_wheel() {
    rm -rf "$target/python/wheels"
    "$target/python/new/bin/maturin" build --locked --manifest-path python/Cargo.toml \
        --target-dir "$target/python/target" --out "$target/python/wheels" "$@"
}

# python_tests FOLDER: the tests of the wheel in an environment. They start many interpreters, and without bytecode on
# the disk each compiles matplotlib anew.
python_tests() {
    "$target/python/$1/bin/pip" install --quiet --no-deps --force-reinstall "$target"/python/wheels/*.whl &&
        PYTHONDONTWRITEBYTECODE='' PYTHONPYCACHEPREFIX=$target/python/$1/bytecode \
            "$target/python/$1/bin/python" -m pytest --quiet -p no:cacheprovider python/tests
}

old_matplotlib() {
    python_environment new 'maturin>=1.9,<2' && python_wheel --release &&
        python_environment old 'matplotlib==3.8.*' 'numpy<2' pytest && python_tests old
}

# --- What .ci/passed says ---

# passed_on PART: the last commit on which a part passed, if this clone has it.
passed_on() {
    local commit
    commit=$(awk -v part="$1" '$1 == part { print $2 }' .ci/passed 2>/dev/null)
    [ -n "$commit" ] && git merge-base --is-ancestor "$commit" HEAD 2>/dev/null && echo "$commit"
}

# Whether nothing that a part guards has changed since the part last passed.
is_settled() {
    local commit
    commit=$(passed_on "$1") || return 1
    # shellcheck disable=SC2046
    git diff --quiet "$commit" -- $(paths "$1") && [ -z "$(git ls-files --others --exclude-standard -- $(paths "$1"))" ]
}

# record PART: notes in .ci/passed that a part passed on this commit.
record() {
    local other
    if [ -n "$(git status --porcelain -- . ':!.ci/passed')" ]; then
        echo "$1 is not noted in .ci/passed: there are changes that are not committed"
        return
    fi
    other=$(grep -v "^$1 " .ci/passed 2>/dev/null || printf '%s\n' \
        "# The last commit on which each part of .ci/nightly passed. The scripts in this folder write this file and read it.")
    { grep '^#' <<<"$other"; { grep -v '^#' <<<"$other"; echo "$1 $(git rev-parse HEAD)"; } | sed '/^$/d' | sort; } \
        >"$logs/passed" && cp "$logs/passed" .ci/passed
}
