"""A Ray cluster of two nodes with a core each, on this machine, for tests: `python -m tests.support.ray_nodes`.

Prints its address when it is up. A line on standard input takes the second node away, as if its machine had lost its
power; the end of the input ends it all.
"""

import os
import sys

from ai.sweep.cluster import LOCAL, worker_environment


def main() -> None:
    os.environ.update(LOCAL | {"RAY_USAGE_STATS_ENABLED": "0"} | worker_environment())
    from ray.cluster_utils import Cluster

    node = {"num_cpus": 1, "object_store_memory": 100 << 20, "include_dashboard": False}
    cluster = Cluster(initialize_head=True, connect=False, head_node_args=node)
    second = cluster.add_node(num_cpus=1, object_store_memory=100 << 20)
    print(cluster.address, flush=True)
    for _ in sys.stdin:
        cluster.remove_node(second, allow_graceful=False)
        print("gone", flush=True)
    cluster.shutdown()


if __name__ == "__main__":
    main()
