# What every scenario uses.

# wait_for SECONDS COMMAND...: until COMMAND succeeds; fails when it has not done so in time.
wait_for() {
    tries=$(($1 * 10))
    shift
    until "$@" > /dev/null 2>&1; do
        tries=$((tries - 1))
        [ $tries -gt 0 ] || return 1
        sleep 0.1
    done
}

# run NAME COMMAND...: what it prints goes to NAME.out and NAME.err, its exit status to NAME.exit. Never fails: the
# status is judged on the other side.
run() {
    run_name=$1
    shift
    run_status=0
    "$@" > "$run_name.out" 2> "$run_name.err" || run_status=$?
    echo $run_status > "$run_name.exit"
}

# run_in_background NAME COMMAND...: the same, as a job; its process id is in NAME.pid, and `finish NAME` waits for it.
run_in_background() {
    job_name=$1
    shift
    "$@" > "$job_name.out" 2> "$job_name.err" &
    echo $! > "$job_name.pid"
}

finish() {
    job_status=0
    wait "$(cat "$1.pid")" || job_status=$?
    rm "$1.pid"
    echo $job_status > "$1.exit"
}

# stop NAME: asks the job to end, unless it has ended by itself, and waits for it. Not with SIGINT: a shell without job
# control starts its jobs with that one ignored.
stop() {
    kill -TERM "$(cat "$1.pid")" 2> /dev/null || true
    finish "$1"
}

# usb_present SERIAL: whether the bus has a device of that serial number.
usb_present() { grep -qsx "$1" /sys/bus/usb/devices/*/serial; }
usb_absent() { ! usb_present "$1"; }

# terminal_of SERIAL: whether cdc_acm has made a terminal of the device.
terminal_of() {
    terminal_device=$(grep -lsx "$1" /sys/bus/usb/devices/*/serial)
    ls "${terminal_device%/serial}":1.0/tty/ttyACM*/dev
}

# capture_is_running FILE: whether samples reach the file.
capture_is_running() { [ "$(stat -c %s "$1")" -gt 4096 ]; }

# judge CAPTURE, analyze CAPTURE: asks the test to check or to analyse the finished capture on the host, where it takes a
# hundredth of the time; the answers are NAME.check and NAME.analyze.
judge() { echo "check $1" >> asked; }
analyze() { echo "analyze $1" >> asked; }
