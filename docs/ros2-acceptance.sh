#!/usr/bin/env bash
# Talks with a real ROS 2 that runs rmw_zenoh_cpp, line by line, and says of each line whether it did what it should.
#
#   docs/ros2-acceptance.sh jazzy|kilted|lyrical
#
# Needs: graphflow and ros2 on the path of one machine (in a ROS 2 container: pip install graphflow there).
# ROS2 names another command line to hold against the same expectations.
set -u
distro=${1:?which distribution: jazzy, kilted or lyrical}
ros2=${ROS2:-ros2}
folder=$(mktemp -d)
export RMW_IMPLEMENTATION=rmw_zenoh_cpp GRAPHFLOW_WIRE=$distro
export ROS_DOMAIN_ID=${ROS_DOMAIN_ID:-77} XDG_STATE_HOME=$folder/state
passed=0 failed=0
pids=()

finish() {
  for pid in "${pids[@]}"; do kill -INT "$pid" 2>/dev/null; done
  (cd "$folder" && graphflow down >/dev/null 2>&1)
  rm -rf "$folder"
  echo "$passed passed, $failed failed"
  [ "$failed" = 0 ] || exit 1
}
trap finish EXIT

# expect WHAT REGEX COMMAND...: the command's output has the regular expression in it.
expect() {
  local what=$1 pattern=$2 output
  shift 2
  output=$(timeout 20 "$@" 2>&1)
  if grep -Eq -- "$pattern" <<<"$output"; then
    passed=$((passed + 1))
    echo "ok    $what"
  else
    failed=$((failed + 1))
    echo "FAIL  $what"
    echo "      $*"
    echo "      wanted: $pattern"
    sed 's/^/      | /' <<<"$output" | head -20
  fi
}

# meanwhile COMMAND...: goes on in the background until the script ends.
meanwhile() {
  "$@" >"$folder/$((${#pids[@]})).log" 2>&1 &
  pids+=($!)
}

mkdir -p "$folder/nodes" "$folder/graphs"
touch "$folder/pyproject.toml"
cat >"$folder/nodes/acceptance.py" <<'PYTHON'
import numpy as np

from graphflow import Durability, Node, Param, Publisher, Qos, service, subscription, task, timer
from graphflow.msgs.example_interfaces.srv import AddTwoInts
from graphflow.msgs.sensor_msgs.msg import Image
from graphflow.msgs.std_msgs.msg import String


class Acceptance(Node):
    """Something of everything that a ROS 2 peer may want."""

    gain = Param(2.0, ge=0.0, le=10.0, doc="How much.")
    label = Param("5", doc="A number in quotes.")
    chatter = Publisher(String, "chatter")
    image = Publisher(Image, "image")
    latched = Publisher(String, "latched", Qos(depth=1, durability=Durability.TRANSIENT_LOCAL))

    @task
    async def keep(self) -> None:
        self.latched.publish(String(data="kept"))

    @timer(0.1)
    def say(self) -> None:
        self.chatter.publish(String(data="hello from graphflow"))
        pixels = np.zeros(921600, np.uint8)
        self.image.publish(Image(height=480, width=640, encoding="rgb8", step=1920, data=pixels))

    @service(AddTwoInts, "add_two_ints", introspection="contents")
    def add(self, request: AddTwoInts.Request) -> AddTwoInts.Response:
        return AddTwoInts.Response(sum=request.a + request.b)

    @subscription(String, "from_ros")
    def heard(self, message: String) -> None:
        self.log.info("heard %s", message.data)
PYTHON
echo 'nodes: {/acceptance: {class: "nodes.acceptance:Acceptance"}}' >"$folder/graphs/acceptance.yaml"
cd "$folder" && graphflow up -d graphs/acceptance.yaml || exit 1

string=RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18
expect "nodes are listed" '^/acceptance$' $ros2 node list
expect "a node's services are listed" '/add_two_ints: example_interfaces/srv/AddTwoInts' $ros2 node info /acceptance
expect "topics have their types" '/chatter \[std_msgs/msg/String\]' $ros2 topic list -t
expect "the type hash is ROS 2's" "Topic type hash: $string" $ros2 topic info -v /chatter
expect "the profile of a latched topic" 'Durability: TRANSIENT_LOCAL' $ros2 topic info -v /latched
expect "a topic is heard" 'data: hello from graphflow' $ros2 topic echo --once /chatter std_msgs/msg/String
expect "an image is heard" 'encoding: rgb8' $ros2 topic echo --once --no-arr /image sensor_msgs/msg/Image
expect "a late joiner gets what is latched" 'data: kept' \
  $ros2 topic echo --once --qos-durability transient_local --qos-reliability reliable /latched std_msgs/msg/String
expect "a message from ROS 2 arrives" 'publishing #3' $ros2 topic pub -t 3 /from_ros std_msgs/msg/String '{data: hello}'
expect "and is logged" 'heard hello' graphflow logs
expect "a service answers" 'sum=5' $ros2 service call /add_two_ints example_interfaces/srv/AddTwoInts '{a: 2, b: 3}'
expect "parameters are listed" 'gain' $ros2 param list /acceptance
expect "a parameter is read" 'Double value is: 2.0' $ros2 param get /acceptance gain
expect "and set" 'Set parameter successful' $ros2 param set /acceptance gain 3.5
expect "one out of range is refused" 'out of range' $ros2 param set /acceptance gain 99.0
expect "parameters are dumped" "label: '5'" $ros2 param dump /acceptance
expect "parameters are described" 'Max value: 10.0' $ros2 param describe /acceptance gain

if [ "$ros2" = ros2 ]; then
  meanwhile ros2 run demo_nodes_cpp talker --ros-args -r chatter:=ros_chatter
  meanwhile ros2 run demo_nodes_cpp add_two_ints_server --ros-args -r add_two_ints:=ros_add
  sleep 3
  expect "graphflow sees ROS 2's node" '^/talker$' graphflow node list
  expect "graphflow hears it" 'data: .Hello World' graphflow topic echo --once /ros_chatter
  expect "graphflow calls it" 'sum=5' graphflow service call /ros_add example_interfaces/srv/AddTwoInts '{a: 2, b: 3}'
  expect "graphflow reads its parameters" 'use_sim_time' graphflow param list /talker
  expect "an image's rate" 'average rate: (9|10)\.' timeout 8 ros2 topic hz /image
  meanwhile ros2 topic pub --qos-durability transient_local --qos-depth 1 -t 1 --keep-alive 30 \
    /ros_latched std_msgs/msg/String '{data: kept by ROS 2}'
  sleep 2
  expect "graphflow gets what ROS 2 has latched" 'kept by ROS 2' \
    graphflow topic echo --once --qos-durability transient_local /ros_latched std_msgs/msg/String
  expect "events of service calls" 'event_type: 1' bash -c \
    "ros2 topic echo --once /add_two_ints/_service_event & sleep 2;
     ros2 service call /add_two_ints example_interfaces/srv/AddTwoInts '{a: 1, b: 1}' >/dev/null; wait"
  # The rendezvous goes and comes back: everybody finds everybody again.
  (cd "$folder" && graphflow down && graphflow up -d graphs/acceptance.yaml) >/dev/null 2>&1
  sleep 3
  expect "after a restart ROS 2 hears graphflow again" 'hello from graphflow' \
    ros2 topic echo --once /chatter std_msgs/msg/String
  expect "after a restart graphflow hears ROS 2 again" 'Hello World' graphflow topic echo --once /ros_chatter
fi
