#!/bin/bash
# A batch on a cluster: one task of a Slurm array for each shard. Submit it from a folder that every
# node sees, and give `rubble batch` the same arguments as on one machine:
#
#   sbatch --array=1-8 --cpus-per-task=4 slurm_array.sh mission.lua --seeds 1..1000 --out dataset
#
# A task that was killed, or ran into its time limit, goes on when it is submitted again. Whichever
# task ends last leaves the complete index.csv.
#SBATCH --job-name=rubble
#SBATCH --signal=TERM@60
exec "${RUBBLE:-rubble}" batch "$@" --shard "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT" \
  --jobs "${SLURM_CPUS_PER_TASK:-1}" --quiet
