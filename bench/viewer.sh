#!/bin/sh
# What the viewer achieves while a scene is orbited, and how soon its window is up: the tables of docs/viewer.md.
#
# usage: bench/viewer.sh [THREADS [RATE]]    after: cargo build --release -p whitted-cli --features viewer
#
# WHITTED_SHARED names the folder with scenes/sponza.ply and scenes/dragon871k.ply; without it they are left out. The
# window is measured if there are Xvfb and xdotool.
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
whitted=${WHITTED:-$root/target/release/whitted}
threads=${1:-2}
fps=${2:-30}
work=$(mktemp -d)
server=
trap '[ -z "$server" ] || kill "$server"; rm -rf "$work"' EXIT

# rate NAME SCENE WIDTH HEIGHT [OPTION...]: orbit for eight seconds; medians of what is reported each second. The last
# column but one is the width and height that as many cores as there are threads allow 30 times a second if nothing else
# takes time from them: from the processor time of a draft, which a busy machine changes little.
rate() {
    name=$1 scene=$2 width=$3 height=$4
    shift 4
    {
        echo "wait refined"
        echo "report"
        echo "key space"
        echo "wait 2"
        for second in 1 2 3 4 5 6 7 8 9; do printf 'report\nwait 1\n'; done
    } >"$work/script"
    rm -f "$work/pipe"
    mkfifo "$work/pipe"
    "$whitted" view "$scene" --threads "$threads" --size "${width}x$height" --fps-target "$fps" "$@" \
        --script "$work/script" >"$work/pipe" &
    viewer=$!
    while read -r line; do
        echo "$(awk '{ print $14 + $15 }' /proc/$viewer/stat) $(date +%s%N) $line"
    done <"$work/pipe" >"$work/report"
    wait $viewer
    awk -v name="$name" -v width="$width" -v height="$height" -v threads="$threads" '
        function median(a, n, i, j, t) {
            for (i = 2; i <= n; i++) for (j = i; j > 1 && a[j] < a[j - 1]; j--) { t = a[j]; a[j] = a[j - 1]; a[j - 1] = t }
            return a[int((n + 1) / 2)]
        }
        NR == 1 { full = $0; sub(/.*finished in /, "", full) }
        NR > 2 {
            n++
            split($5, size, /[x,]/)
            fps[n] = $3
            share[n] = 100 * size[1] / width
            depth = $7
            weight = $10
            draft = (($1 - ticks) / 100) / (($2 - time) / 1e9) / $3
            free[n] = draft > 0 ? share[n] * sqrt(threads * 0.92 / 30 / draft) : 0
            if (free[n] > 100) free[n] = 100
        }
        { ticks = $1; time = $2 }
        END {
            gsub(/,/, "", weight)
            printf "| %s | %d×%d | %.0f | %.0f %% | %d | %s | %.0f %% | %s |\n", name, width, height, median(fps, n),
                median(share, n), depth, weight, median(free, n), full
        }
    ' "$work/report"
}

# start SCENE: milliseconds from the command to a window on the display, five times.
start() {
    for turn in 1 2 3 4 5; do
        before=$(date +%s%N)
        "$whitted" view "$1" >/dev/null &
        viewer=$!
        until [ -n "$(xdotool search --onlyvisible --pid $viewer 2>/dev/null)" ]; do :; done
        after=$(date +%s%N)
        kill $viewer
        wait $viewer 2>/dev/null || :
        echo $(((after - before) / 1000000))
    done | sort -n | sed -n 3p
}

# furnished NAME: a scene around a mesh of the shared folder.
furnished() {
    camera=$(awk '$1 == "eye" || $1 == "at" { printf "%s = [%s, %s, %s]\n", $1 == "at" ? "look_at" : $1, $2, $3, $4 }
        $1 == "fovy" { print "vfov = " $2 }' "$WHITTED_SHARED/scenes/$1.cam")
    light=$(awk '$1 == "light" { printf "point = [%s, %s, %s]\n", $2, $3, $4 }' "$WHITTED_SHARED/scenes/$1.cam")
    printf 'version = 1\n[camera]\n%s\n[[light]]\n%s\n[material.default]\ncolor = [0.7, 0.7, 0.7]\n%s\n' "$camera" "$light" "${2:-}"
    printf '[[mesh]]\nfile = "%s"\nmaterial = "default"\n' "$WHITTED_SHARED/scenes/$1.ply"
}

# edits: save the still life nine times, each time with other colours; milliseconds until that is seen.
edits() {
    cp "$root/scenes/still-life.toml" "$work/edited.toml"
    {
        echo "wait refined"
        for turn in 1 2 3 4 5 6 7 8 9; do printf 'wait 1.5\nreport\n'; done
    } >"$work/script"
    "$whitted" view "$work/edited.toml" --threads "$threads" --size 1280x720 --script "$work/script" >"$work/report" &
    viewer=$!
    sleep 3
    while kill -0 $viewer 2>/dev/null; do
        sed -i "s/color = \"#[0-9a-f]*/color = \"#80$(date +%N | cut -c1-4)/" "$work/edited.toml"
        sleep 1.37
    done
    sed -n 's/.*seen after \([0-9]*\) ms/\1/p' "$work/report" | sort -n | awk '{ a[NR] = $1 } END { print a[int((NR + 1) / 2)] " (at most " a[NR] ")" }'
}

echo "| scene | window | pictures a second | width and height | depth | weights from | of free cores | full quality |"
echo "| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |"
rate mix-1000 "$root/scenes/mix-1000.toml" 640 480
rate mix-1000 "$root/scenes/mix-1000.toml" 1280 720
rate still-life "$root/scenes/still-life.toml" 1280 720
if [ -n "${WHITTED_SHARED:-}" ]; then
    for mesh in sponza dragon871k; do
        furnished $mesh >"$work/$mesh.toml"
        rate "$mesh" "$work/$mesh.toml" 1280 720 --allow-outside
    done
fi
rate mix-50000 "$root/scenes/mix-50000.toml" 1280 720

echo
echo "a saved change is seen after $(edits) ms"

if command -v Xvfb >/dev/null && command -v xdotool >/dev/null; then
    DISPLAY=:$((200 + $$ % 300))
    export DISPLAY
    Xvfb $DISPLAY -screen 0 1400x900x24 -noreset >/dev/null 2>&1 &
    server=$!
    until xdotool getdisplaygeometry >/dev/null 2>&1; do :; done
    echo
    for scene in still-life mix-50000; do
        echo "$scene: window up after $(start "$root/scenes/$scene.toml") ms"
    done
fi
