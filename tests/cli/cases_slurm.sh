# cag batch --engine-queue slurm on a real Slurm of this machine: its own munge, controller, and node, on the loopback interface, in this
# folder. Everything is shut down at the end. Skipped if that is impossible.

script ball.cag 'param r = 10
show sphere(r)'
printf 'script,output,r\nball.cag,a.stl,1\nball.cag,b.stl,2\nball.cag,c.stl,-3\n' > jobs.csv

# All tests except this one need a Slurm.
it 'a Slurm that is not there: the rows are reported, and can be run later'
slurm_first=$test_name
mkdir empty
! have povray || ln -s "$(command -v povray)" empty/povray
(PATH=$PWD/empty; SLURM_CONF=/nowhere "$CAG" batch jobs.csv --engine-queue slurm > out 2> err)
code=$?
ran='cag batch --engine-queue slurm (without Slurm)'
status 1
says 'E0918'
prints_exactly '0 done, 3 failed, 0 skipped (already done)'

slurm_missing=
for program in munged mungekey slurmctld slurmd sbatch squeue; do
  PATH=$PATH:/usr/sbin command -v $program > /dev/null 2>&1 || slurm_missing="$slurm_missing $program"
done
if [ "$(id -u)" -ne 0 ]; then
  skip_behind slurm "$slurm_first" 'it takes root'
elif [ -n "$slurm_missing" ]; then
  skip_behind slurm "$slurm_first" "there is no$slurm_missing (apt-get install slurmctld slurmd munge slurm-client)"
else

PATH=$PATH:/usr/sbin
slurm=$PWD/slurm
mkdir -p slurm/controller slurm/node
mungekey -c -k slurm/munge.key
munged --key-file="$slurm/munge.key" --socket="$slurm/munge.socket" --pid-file="$slurm/munge.pid" --log-file="$slurm/munge.log" \
  --seed-file="$slurm/munge.seed" --num-threads=2 --force 2> /dev/null
# Ports that no other test uses.
port=$((20000 + $$ % 20000))
cat > slurm/slurm.conf <<END
ClusterName=test
SlurmctldHost=localhost(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 1))
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$slurm/munge.socket
CredType=cred/munge
StateSaveLocation=$slurm/controller
SlurmdSpoolDir=$slurm/node
SlurmctldPidFile=$slurm/controller.pid
SlurmdPidFile=$slurm/node.pid
SlurmctldLogFile=$slurm/controller.log
SlurmdLogFile=$slurm/node.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SchedulerParameters=sched_interval=1,bf_interval=1,batch_sched_delay=0
MaxArraySize=5
ReturnToService=2
SlurmdTimeout=5
KillWait=2
MessageTimeout=5
NodeName=localhost NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=60 State=UP
END
# By default, a node searches for control groups. Those of version 1 are accepted unchanged; the plugins above need none.
echo CgroupPlugin=cgroup/v1 > slurm/cgroup.conf
SLURM_CONF=$slurm/slurm.conf
export SLURM_CONF
start_controller() { slurmctld -f "$SLURM_CONF"; }
start_node() { slurmd -N localhost -f "$SLURM_CONF"; }
stop() { [ -s "slurm/$1.pid" ] && kill "${2:--TERM}" "$(cat "slurm/$1.pid")" 2> /dev/null; }
has_ended() { ! kill -0 "$1" 2> /dev/null; }
end_slurm() {
  scancel -u root 2> /dev/null
  for daemon in node controller munge; do
    [ -s "$slurm/$daemon.pid" ] || continue
    pid=$(cat "$slurm/$daemon.pid")
    kill "$pid" 2> /dev/null
    waits_for has_ended "$pid" || kill -KILL "$pid"
  done
}
trap 'end_slurm; rm -rf "$work"' EXIT
waits_for() {
  for _ in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30; do
    "$@" && return 0
    sleep 0.5
  done
  return 1
}
node_is() { sinfo -h -o %t 2> /dev/null | grep -q "$1"; }
start_controller > /dev/null 2>&1
start_node > /dev/null 2>&1
waits_for node_is idle

if ! node_is idle; then
  skip_behind slurm "$slurm_first" "its node does not begin here: $(tail -n 2 slurm/node.log | head -n 1)"
  end_slurm
else

it 'Slurm begins'
ran=sinfo code=0
node_is idle || wrong "the node is not there: $(tail -n 5 slurm/controller.log slurm/node.log 2>&1)"

it 'the rows are done as one array job, and one that fails is told'
try batch jobs.csv --engine-queue slurm --retries 1
status 1
prints_exactly '2 done, 1 failed, 0 skipped (already done)'
says 'E0917: row 3: '
exists a.stl
exists b.stl
[ "$(cut -d, -f4 jobs.report.csv | tail -n +2 | tr '\n' ' ')" = 'done done failed ' ] || wrong 'the report is another'
[ "$(cut -d, -f7 jobs.report.csv | tail -n +2 | tr '\n' ' ')" = '1 1 2 ' ] || wrong 'the attempts are others'
[ "$(squeue -h -t all -o %F | sort -u | wc -l)" -eq 1 ] || wrong 'it is not one job'
is_missing jobs.csv.slurm

it 'a second call hands in only what failed'
sed -i 's/-3$/3/' jobs.csv
try batch jobs.csv --engine-queue slurm
status 0
prints_exactly '1 done, 0 failed, 2 skipped (already done)'
try batch jobs.csv --engine-queue slurm
prints_exactly '0 done, 0 failed, 3 skipped (already done)'
[ "$(squeue -h -t all -o %F | sort -u | wc -l)" -eq 2 ] || wrong 'there are not two jobs'

it 'more rows than an array may have elements, and a picture in tiles' povray
{
  echo script,output,r,size,quality,tiles
  for i in 1 2 3 4 5 6 7; do echo "ball.cag,m$i.stl,$i,,,"; done
  echo ball.cag,t.exr,,96x64,draft,3x2
} > more.csv
try batch more.csv --engine-queue slurm
status 0
prints_exactly '8 done, 0 failed, 0 skipped (already done)'
try render ball.cag -o whole.exr --size 96x64 --quality draft
try compare t.exr whole.exr
status 0
is_missing more.csv.tiles

# A renderer that waits until a file exists.
mkdir waiting
cat > waiting/povray <<END
#!/bin/sh
while [ ! -e $PWD/go ]; do sleep 0.2; done
exec /usr/bin/povray "\$@"
END
chmod +x waiting/povray
printf 'script,output,size,quality\nball.cag,w1.stl,,\nball.cag,w2.png,32x24,normal\nball.cag,w3.png,32x24,normal\n' > wait.csv
runs_job() { squeue -h -t running -o %K 2> /dev/null | grep -q .; }
begin_waiting() {
  (PATH=$PWD/waiting:$PATH exec "$CAG" batch wait.csv --engine-queue slurm > out 2> err) &
  child=$!
  waits_for runs_job
  sleep 1
}

it 'after Ctrl-C the job goes on, and the next call takes it up'
ran='cag batch --engine-queue slurm (SIGTERM)'
begin_waiting
kill -TERM $child
wait $child
code=$?
status 130
says 'run the same command to resume'
runs_job || wrong 'the job does not go on'
touch go
try batch wait.csv --engine-queue slurm
status 0
says "resuming Slurm job"
prints_like '[23] done, 0 failed'
exists w2.png
exists w3.png

it 'a batch that is killed is taken up as well'
rm -f go wait.csv.journal w?.*
begin_waiting
kill -KILL $child
wait $child 2> /dev/null
touch go
try batch wait.csv --engine-queue slurm
status 0
says "resuming Slurm job"
try batch wait.csv
prints_exactly '0 done, 0 failed, 3 skipped (already done)'

it 'a job that somebody cancels: its rows are reported and can be resumed' povray
rm -f go wait.csv.journal w?.*
ran='cag batch --engine-queue slurm (scancel)'
begin_waiting
scancel -u root
wait $child
code=$?
status 1
says 'CANCELLED'
prints_like '1 done, 2 failed'
touch go
try batch wait.csv --engine-queue slurm
status 0
prints_exactly '2 done, 0 failed, 1 skipped (already done)'

it 'a node that is lost: its rows are reported and can be resumed' povray
rm -f go wait.csv.journal w?.*
ran='cag batch --engine-queue slurm (the node dies)'
begin_waiting
# The node with everything that runs on it: the elements, the processes that wait for them, and the renderers.
stop node -KILL
for process in /proc/[0-9]*; do
  if grep -q -a -e "$PWD/wait.csv.slurm" -e "$PWD/waiting/povray" "$process/cmdline" 2> /dev/null; then
    parent=$(sed -n 's/^PPid:[^0-9]*//p' "$process/status" 2> /dev/null)
    grep -q slurmstepd "/proc/$parent/comm" 2> /dev/null && kill -KILL "$parent"
    kill -KILL "${process#/proc/}" 2> /dev/null
  fi
done
wait $child
code=$?
status 1
says 'E0917'
says_like 'NODE_FAIL\|FAILED\|without a result'
prints_like '1 done, 2 failed'
touch go
start_node > /dev/null 2>&1
waits_for node_is idle
try batch wait.csv --engine-queue slurm
status 0
prints_exactly '2 done, 0 failed, 1 skipped (already done)'

it 'a job that Slurm refuses: the rows are reported'
printf 'script,output\nball.cag,r.stl\n' > refused.csv
ran='cag batch --engine-queue slurm (a partition that there is not)'
SBATCH_PARTITION=nothere "$CAG" batch refused.csv --engine-queue slurm > out 2> err
code=$?
status 1
says 'E0918: Slurm refused the job: '
prints_exactly '0 done, 1 failed, 0 skipped (already done)'
[ "$(cut -d, -f4 refused.report.csv | tail -n 1)" = failed ] || wrong 'the report is another'

it 'a Slurm that is down: the rows are reported and can be resumed'
stop controller
sleep 1
try batch refused.csv --engine-queue slurm
status 1
says 'E0918: Slurm does not respond: '
start_controller > /dev/null 2>&1
waits_for node_is idle
try batch refused.csv --engine-queue slurm
status 0
prints_exactly '1 done, 0 failed, 0 skipped (already done)'

end_slurm
trap 'rm -rf "$work"' EXIT
unset SLURM_CONF
fi
fi
