"""Sweeps a unit under Ray: a task a shard, all leaves in one folder that every worker sees.

    python with_ray.py --unit sum --shards 64 -o leaves [--only COLUMN=NUMBERS]... [--address auto]

Ray starts a task again when its worker dies; the new one computes what the dead one left undone. NINEBIT names the program.
"""

import argparse
import os
import pathlib
import subprocess
import time

import ray


# A worker that dies is replaced up to three times; a sweep that fails says why and is not tried again.
@ray.remote(num_cpus=1, max_retries=3)
def sweep(unit, only, shard, shards, folder, dies):
    mark = pathlib.Path(f"{folder}.killed")
    command = [os.environ.get("NINEBIT", "ninebit"), "vectors", "sweep", "--unit", unit, "--threads", "1"]
    command += [word for columns in only for word in ("--only", columns)]
    command += ["--shard", f"{shard}/{shards}", "-o", folder]
    if dies and not mark.exists():
        mark.touch()
        worker = subprocess.Popen(command, stdout=subprocess.DEVNULL)
        # In the middle: its first leaf is there.
        while not pathlib.Path(folder, f"leaf-{shard - 1:04}.json").exists() and worker.poll() is None:
            time.sleep(0.001)
        worker.kill()
        os.kill(os.getpid(), 9)
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--unit", required=True)
    parser.add_argument("--only", action="append", default=[], help="a part: COLUMN=NUMBERS, as of `vectors sweep`")
    parser.add_argument("--shards", type=int, default=64)
    parser.add_argument("--kill", type=int, help="the shard whose worker dies once, as a test")
    parser.add_argument("--address", help="of a cluster; without it Ray runs on this machine")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True)
    arguments = parser.parse_args()
    environment = {"NINEBIT": str(pathlib.Path(os.environ.get("NINEBIT", "ninebit")).absolute())}
    ray.init(address=arguments.address, runtime_env={"env_vars": environment}, include_dashboard=False)
    folder = str(arguments.output.absolute())
    tasks = [
        sweep.remote(arguments.unit, arguments.only, shard, arguments.shards, folder, shard == arguments.kill)
        for shard in range(1, arguments.shards + 1)
    ]
    for text in ray.get(tasks):
        print(text)
    killed = pathlib.Path(f"{folder}.killed")
    if arguments.kill:
        killed.unlink()  # It fails if nobody was killed.


if __name__ == "__main__":
    main()
