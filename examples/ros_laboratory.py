"""The paper's laboratory demonstration over ROS topics: a simulated robot, the node, and a client that commands.

Run it with `python examples/ros_laboratory.py`; it needs the extra ros. Each is a process of its own, and they know one
another by their messages alone.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from typing import Any

os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
os.environ.setdefault("ROS_DOMAIN_ID", "42")

import rclpy
from std_msgs.msg import String
from std_srvs.srv import Trigger

MODULES = ("dcg_torch.apps.ros.simulated",), ("dcg_torch.ros", "--ros-args", "-p", "model:=paper")


def call(node: Any, service: str) -> str:
    """What a service without an argument answers."""
    client = node.create_client(Trigger, service)
    client.wait_for_service()
    future = client.call_async(Trigger.Request())
    rclpy.spin_until_future_complete(node, future)
    return str(future.result().message)


def main() -> None:
    """Start the two, and give the three commands."""
    processes = [subprocess.Popen([sys.executable, "-m", *module]) for module in MODULES]
    rclpy.init()
    node = rclpy.create_node("client")
    ended: dict[str, Any] = {}

    def on_acknowledgement(message: Any) -> None:
        said = json.loads(message.data)
        if said["state"] not in ("accepted", "refused"):
            ended[said["id"]] = said

    node.create_subscription(String, "/dcg_torch/acknowledgement", on_acknowledgement, 100)
    commands = node.create_publisher(String, "/dcg_torch/command", 100)
    try:
        call(node, "/dcg_torch/lexicon")  # answered when the node is ready
        for text in ("move towards the cone", "move towards the cube", "move towards the crate"):
            call(node, "/reset")
            while text not in ended:  # a message may be lost; with its id it is carried out once
                commands.publish(String(data=json.dumps({"id": text, "text": text})))
                until = time.monotonic() + 2.0
                while text not in ended and time.monotonic() < until:
                    rclpy.spin_once(node, timeout_sec=0.1)
            said = ended[text]
            print(f"{text}: {said['said']}, probability {said['probability']:.2f}, learned {said.get('learned')}")
    finally:
        for process in processes:
            process.terminate()
        for process in processes:
            process.wait()


if __name__ == "__main__":
    main()
