# Steps side by side: lanes that run at the same time, each one step after the other.
#
#   logs=$(mktemp -d)
#   first() { step make lint; step make docs; }
#   second() { step make campaign; }
#   side_by_side first second
#
# A step's output is shown whole when it has ended. The first step that fails is named and ends all lanes.

step() {
    local log began=$SECONDS status=0
    log=$(mktemp -p "$logs")
    "$@" >"$log" 2>&1 </dev/null || status=$?
    (
        flock 9
        printf '==== %s\n' "$*"
        cat "$log"
        printf '==== %s: %s after %s s\n' "$*" "$( ((status)) && echo FAILED || echo done)" $((SECONDS - began))
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
