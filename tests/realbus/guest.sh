#!/bin/sh
# First process of the guest: brings up CAN interfaces and lets ipos, can-utils and python3-can talk over them. Each
# part leaves files in FOLDER, which realbus_test.cpp looks at.
mount -t proc proc /proc
mount -t sysfs sys /sys
mount -t tmpfs tmp /run
mkdir -p /dev/pts
mount -t devpts devpts /dev/pts
cd "$FOLDER" || busybox poweroff -f
: >booted
trap 'busybox poweroff -f' EXIT
here=project/tests/realbus

modules=$(echo /usr/lib/uml/modules/*/kernel)
for module in drivers/net/can/dev/can-dev net/can/can net/can/can-raw drivers/net/can/vcan \
  drivers/net/can/slcan/slcan net/sched/sch_tbf; do
  busybox insmod "$modules/$module.ko" 2>no-can || exit
done
ip link add vcan0 type vcan 2>no-can && ip link set vcan0 up 2>no-can && ip link add vcan1 type vcan 2>no-can || exit
rm no-can

# A part waits for what it needs, not for a time: on a loaded machine everything comes later. What has not come within a
# minute stands in waits.txt, which every test shows.
wait_until() {
  what=$1
  shift
  n=0
  until "$@" 2>/dev/null; do
    n=$((n + 1))
    [ $n -lt 1200 ] || { echo "not within a minute: $what" >>waits.txt; return 1; }
    busybox usleep 50000
  done
}
has_lines() { [ "$(grep -c "$1" "$2")" -ge "$3" ]; }
wait_for() { wait_until "'$1' in $2" grep -q "$1" "$2"; }
wait_for_lines() { wait_until "$3 times '$1' in $2" has_lines "$1" "$2" "$3"; }
# A candump without filters on this interface takes frames.
wait_for_listener() { wait_until "somebody who listens at $1" grep -q "$1  *000 " /proc/net/can/rcvlist_all; }
is_up() { ip link show "$1" | grep -q "UP"; }
as_long_as() { [ "$(grep -c . "$1")" -ge "$(grep -c . "$2")" ]; }
# A file that does not grow any more for half a second.
stands_still() {
  before=$(busybox stat -c %s "$1")
  busybox usleep 500000
  [ "$(busybox stat -c %s "$1")" = "$before" ]
}

# plant FILE PORT: a plant file with its bus joined to a port, on stdout.
plant() { sed "s|^kind = \"can\"|&\nport = \"$2\"|" "$1"; }

# Frame 7FF asks whether the log has begun, frames 7FE mark its parts.
candump -L vcan0 >all.log &
log=$!
until grep -q 7FF# all.log; do cansend vcan0 7FF#; busybox usleep 50000; done
canbusload -e vcan0@500000 >load.txt &
load=$!
wait_for vcan0 load.txt

# The SCOM example, and parameter requests between its frames.
cp project/examples/scom/*.IPC .
plant project/examples/scom/scom.toml vcan0 >scom.toml
./ipos bus monitor vcan0 --plant scom.toml >monitor.txt 2>monitor.err &
monitor=$!
wait_for monitoring monitor.err
./ipos bus monitor vcan0 --plant scom.toml --station unit1 --count 10 >monitor1.txt 2>monitor1.err &
cansend vcan0 7FE#01
./ipos run scom.toml --realtime --for 3s --log scom.log >scom.out 2>scom.err &
run=$!
wait_for_lines " 400#" all.log 3
cansend vcan0 20B#3100211600000000
cansend vcan0 20B#3200207E00000001
wait $run
echo $? >scom.code
kill -INT $monitor
wait $monitor
echo $? >monitor.code

# A station driven through its profile, until we end it.
cansend vcan0 7FE#02
plant $here/profile.toml vcan0 >profile.toml
./ipos run profile.toml --realtime --for 1000s >profile.out 2>profile.err &
run=$!
wait_for joined profile.err
/usr/bin/python3 -B $here/profile.py >profile.txt 2>&1
kill -TERM $run
wait $run
echo $? >profile.code
cansend vcan0 7FE#03
wait_for 7FE#03 all.log
# canbusload tells each second: two more seconds, and it has told everything.
wait_for_lines vcan0@ load.txt $(($(grep -c vcan0@ load.txt) + 3))
kill $load $log

# Interfaces that cannot be used.
for port in vcan1 lo can7; do
  plant project/examples/scom/scom.toml $port >refused.toml
  ./ipos run refused.toml --realtime --for 1s 2>&1
  echo "exit code $?"
done >refused.txt

# The kernel's slcan driver on our end of a pseudo-terminal.
plant project/examples/scom/scom.toml "slcan:pty:$FOLDER/adapter" >slcan.toml
./ipos run slcan.toml --realtime --for 1000s >slcan.out 2>slcan.err &
run=$!
wait_for joined slcan.err
slcand -o -c -s6 "..$FOLDER/adapter" slcan0
wait_until "the interface slcan0" ip link show slcan0 >/dev/null
ip link set slcan0 up
wait_until "slcan0 up" is_up slcan0
candump -L slcan0 >slcan.log &
log=$!
wait_for_listener slcan0
cansend slcan0 20B#3100211600000000
wait_for " 20C#" slcan.log
wait_for_lines " 400#" slcan.log 5
kill $log
ip link set slcan0 down
ip link set slcan0 type can bitrate 250000
ip link set slcan0 up
wait_for "refused to open" slcan.err
plant project/examples/scom/scom.toml slcan0 >rate.toml
./ipos run rate.toml --realtime --for 1s >rate.txt 2>&1
echo "exit code $?" >>rate.txt
kill -INT $run
wait $run
busybox killall slcand

# An interface whose queue holds 10 frames and hardly sends for a while: the system says ENOBUFS.
cp $here/load.IPC .
ip link add vcan2 type vcan
ip link set vcan2 up
tc qdisc add dev vcan2 root tbf rate 1kbit burst 100 limit 160
echo 4000000 >/proc/sys/net/core/rmem_max
candump -L -r 4000000 vcan2 >full.log &
log=$!
wait_for_listener vcan2
plant $here/load.toml vcan2 >load.toml
./ipos run load.toml --realtime --for 1500ms --speed 100 --log load.log >load.out 2>load.err &
run=$!
# The interface has refused frames: they are counted as requeues or drops, or its ten places are taken.
is_full() { tc -s qdisc show dev vcan2 | grep -Eq "dropped [1-9]|backlog [0-9]+b ([89]|1[0-9])p"; }
wait_until "a full interface vcan2" is_full
tc qdisc change dev vcan2 root tbf rate 10mbit burst 10000 limit 160
wait $run
wait_until "all frames of load.log in full.log" as_long_as full.log load.log
kill $log

# A monitor that is stopped for a while loses frames, and an error frame of a controller: no acknowledge.
ip link add vcan3 type vcan
ip link set vcan3 up
./ipos bus monitor vcan3 --station 1 >lost.txt 2>lost.err &
monitor=$!
wait_for monitoring lost.err
kill -STOP $monitor
cangen vcan3 -g 0 -I 20B -L 8 -D 3100207E00000000 -n 12000
kill -CONT $monitor
wait_for "read 8318" lost.txt
wait_until "the end of lost.txt" stands_still lost.txt
cansend vcan3 20C#3100207E000F4240
wait_for 1000.000 lost.txt
for n in 1 2 3; do cansend vcan3 20000020#0000000000000000; done
wait_for "no ack" lost.txt
cansend vcan3 20C#31002116000007D0
wait_for 2.000 lost.txt
ip link set vcan3 down
wait_for "set down" lost.err
kill -INT $monitor
wait $monitor
echo $? >lost.code

# A served plant whose interface is set down and up, and is removed and made again: frames come behind that.
ip link set lo up
ip link add vcan5 type vcan
ip link set vcan5 up
plant project/examples/scom/scom.toml vcan5 >served.toml
./ipos serve served.toml >served.out 2>served.err &
served=$!
wait_for http served.out
ip link set vcan5 down
wait_for "away: the interface is down" served.err
ip link set vcan5 up
wait_for "vcan5 is there again" served.err
candump -L -n 3 -T 60000 vcan5,400:7FF >up.log
ip link del vcan5
wait_for "away: the device has gone" served.err
ip link add vcan5 type vcan
ip link set vcan5 up
wait_for_lines "vcan5 is there again" served.err 2
candump -L -n 3 -T 60000 vcan5,400:7FF >anew.log
kill -INT $served
wait $served
echo $? >served.code

# A CANopen master on three nodes, with 200 SYNC cycles.
ip link add vcan4 type vcan
ip link set vcan4 up
plant $here/canopen.toml vcan4 >canopen.toml
./ipos canopen eds canopen.toml a -o a.eds
/usr/bin/python3 -B $here/canopen_master.py ./ipos canopen.toml vcan4 a.eds canopen.log 200 >canopen.txt 2>&1
echo $? >canopen.code
: >done
