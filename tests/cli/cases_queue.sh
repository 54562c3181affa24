# cag batch --engine-queue slurm with programs in the place of Slurm's: what they are asked, and what their answers mean.
# cases_slurm.sh has a real Slurm.

script ball.cag 'param r = 10
show sphere(r)'
mkdir fake
fake() {
  cat > "fake/$1"
  chmod +x "fake/$1"
}
# An sbatch that runs all elements at once. Its words are kept.
good_sbatch() {
  fake sbatch <<'END'
#!/bin/sh
printf '%s\n' "$@" > words
for last; do :; done
for element in 0 1 2; do SLURM_ARRAY_TASK_ID=$element sh "$last"; done
echo 17
END
}
fake scontrol <<'END'
#!/bin/sh
echo 'MaxArraySize = 3'
END
fake squeue <<'END'
#!/bin/sh
printf '0 COMPLETED\n1 COMPLETED\n'
END
queue() { try_command env PATH="$PWD/fake:$PATH" "$CAG" batch "$@" --engine-queue slurm; }
held() { grep -qxF -e "$2" "$1" || wrong "$1 lacks $2: $(cat "$1")"; }

it 'the job has the limits of the command line'
good_sbatch
printf 'script,output,r\nball.cag,a.stl,1\nball.cag,b.stl,2\nball.cag,c.stl,3\n' > jobs.csv
queue jobs.csv --jobs 2 --threads 3 --max-time 100 --retries 1
status 0
prints_exactly '3 done, 0 failed, 0 skipped (already done)'
says "submitted Slurm job 17 with 3 tasks"
held words '--array=0-1%2'
held words '--cpus-per-task=3'
# An element has two of the three tasks, each tried twice at most for 1.1 * 100 + 1 s, and a minute to begin: 8.4 minutes.
held words '--time=9'
is_missing jobs.csv.slurm

it 'quotes and percent signs in the name of the folder'
mkdir "it's 5%a"
cp ball.cag "it's 5%a"
printf 'script,output\nball.cag,a.stl\n' > "it's 5%a/jobs.csv"
fake scontrol <<'END'
#!/bin/sh
echo nothing
END
queue "it's 5%a/jobs.csv"
status 0
exists "it's 5%a/a.stl"
held words '--output=/dev/null'
held words '--array=0-0'

it 'a Slurm that fails without a word'
printf 'script,output,r\nball.cag,a.stl,1\nball.cag,b.stl,2\n' > two.csv
fake scontrol <<'END'
#!/bin/sh
exit 1
END
queue two.csv
status 1
says 'E0918: Slurm does not respond: no answer'
prints_exactly '0 done, 2 failed, 0 skipped (already done)'
fake scontrol <<'END'
#!/bin/sh
echo 'MaxArraySize = 1001'
END

it 'the folder of the job cannot be made'
: > two.csv.slurm
queue two.csv
status 3
says 'two.csv.slurm/cag-'
says 'cannot create the folder'
rm two.csv.slurm

it 'elements that Slurm does not know any more are lost'
fake sbatch <<'END'
#!/bin/sh
echo 18
END
fake squeue <<'END'
#!/bin/sh
printf 'N/A PENDING\n99 RUNNING\nnothing\n'
END
queue two.csv
status 1
says 'E0917: row 1: Slurm ended its task 0 without a result: the job is no longer known'
says 'E0917: row 2: Slurm ended its task 1 without a result: the job is no longer known'
prints_exactly '0 done, 2 failed, 0 skipped (already done)'

it 'a Slurm that does not answer for a while is waited for'
fake sbatch <<'END'
#!/bin/sh
for last; do :; done
echo "$last" > array
echo 19
END
fake squeue <<'END'
#!/bin/sh
if [ ! -e asked ]; then
  touch asked
  printf 'squeue: the controller is away\n \n'
  exit 1
fi
for element in 0 1; do SLURM_ARRAY_TASK_ID=$element sh "$(cat array)"; done
printf '0 RUNNING\n1 RUNNING\n'
END
queue two.csv
status 0
says 'Slurm does not respond (squeue: the controller is away), waiting'
prints_exactly '2 done, 0 failed, 0 skipped (already done)'

# A journal whose last line is a job that was handed in.
submitted='{"what":"submitted","key":"cag-1"}'
it 'a job whose folder somebody removed: its rows are handed in again'
good_sbatch
rm -f a.stl b.stl two.csv.journal
echo "$submitted" > two.csv.journal
queue two.csv
status 0
prints_exactly '2 done, 0 failed, 0 skipped (already done)'

it 'a job that Slurm has forgotten: what it did is taken, the rest is handed in again'
rm -f two.csv.journal
echo "$submitted" > two.csv.journal
mkdir -p two.csv.slurm/cag-1
echo '{"elements":1,"folder":"/","tasks":[{"key":"ofanotherrow","words":["cag"]}]}' > two.csv.slurm/cag-1/plan.json
queue two.csv
status 0
prints_exactly '2 done, 0 failed, 0 skipped (already done)'
is_missing two.csv.slurm

it 'a plan that is none'
echo "$submitted" >> two.csv.journal
mkdir -p two.csv.slurm/cag-1
echo '{}' > two.csv.slurm/cag-1/plan.json
queue two.csv
status 3
says 'is not a plan of a batch'
rm -r two.csv.slurm

it 'an element does its tasks, and none twice'
mkdir element
cd element
plan() { echo "{\"elements\":2,\"retries\":1,\"folder\":\"$PWD\",\"tasks\":[$1]}" > plan.json; }
plan '{"key":"k0","words":["sh","-c","echo 0 >> done"]},{"key":"k1","words":["sh","-c","echo 1 >> done"]},{"key":"k2","words":["sh","-c","echo 2 >> done; exit 3"]}'
try batch --element 0 plan.json
status 0
holds done '0
2
2'
grep -q '"status":0' k0.json || wrong 'the result of the first task is another'
grep -q '"status":3.*"attempts":2' k2.json || wrong 'the result of the third task is another'
try batch --element 1 "$PWD/plan.json"
try batch --element 1 plan.json
holds done '0
2
2
1'
plan '{"key":"none","words":["/no/such/program"]}'
try batch --element 0 plan.json
status 0
grep -q '"status":127' none.json || wrong 'a missing program has another status'
plan '{"key":"no/where","words":["true"]}'
try batch --element 0 plan.json
status 3
says 'no/where.json'
cd ..
