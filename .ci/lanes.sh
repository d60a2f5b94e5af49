# Steps side by side: lanes that run at the same time, each one step after the other.
#
#   logs=$(mktemp -d)
#   first() { step make lint; step make docs; }
#   second() { step make campaign; }
#   side_by_side first second
#
# A step's output is shown whole when it has ended, with the seconds that it took, and those of a processor. The first
# step that fails is named and ends all lanes.

step() {
    local log used status=0 TIMEFORMAT='%0R s, %0U + %0S s of a processor'
    log=$(mktemp -p "$logs")
    used=$({ time "$@" >"$log" 2>&1 </dev/null; } 2>&1) || status=$?
    (
        flock 9
        printf '==== %s\n' "$*"
        cat "$log"
        printf '==== %s: %s after %s\n' "$*" "$( ((status)) && echo FAILED || echo done)" "$used"
    ) 9>>"$logs/lock"
    return "$status"
}

side_by_side() {
    local lane lanes=() failed=
    set -m # each lane is a group of processes, which can be ended as one
    for lane in "$@"; do
        (
            set -e
            "$lane"
        ) &
        lanes+=($!)
    done
    trap 'kill -- "${lanes[@]/#/-}" 2>/dev/null || :; exit 130' INT TERM
    for lane in "$@"; do
        wait -n || {
            failed=yes
            break
        }
    done
    [[ -z $failed ]] || kill -- "${lanes[@]/#/-}" 2>/dev/null || :
    trap - INT TERM
    set +m
    [[ -z $failed ]]
}
