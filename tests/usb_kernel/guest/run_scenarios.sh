# Runs the scenarios one after the other. Each has a folder of its own on the share, where it leaves log, status (its exit
# status), and what it wants to be judged by.
set -u
failed=0
for scenario in /test/scenarios/*.sh; do
    name=$(basename "$scenario" .sh)
    mkdir -p "/share/$name"
    begin=$(cut -d. -f1 /proc/uptime)
    # The work is done in memory: what is tested is USB, and the share is slow.
    mkdir -p "/tmp/$name"
    (cd "/tmp/$name" && timeout 400 sh -eux "/test/scenarios/$name.sh") > "/share/$name/log" 2>&1
    status=$?
    for job in /tmp/$name/*.pid; do
        [ -e "$job" ] && kill "$(cat "$job")" 2> /dev/null
    done
    rm -f "/tmp/$name"/*.pid
    cp "/tmp/$name"/* "/share/$name/" 2> /dev/null
    rm -rf "/tmp/$name"
    echo $status > "/share/$name/status"
    echo "$name: $status after $(($(cut -d. -f1 /proc/uptime) - begin)) s"
    [ $status -eq 0 ] || failed=1
done
exit $failed
