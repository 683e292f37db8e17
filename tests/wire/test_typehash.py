"""Type hashes against those of ROS 2's own generator."""

from __future__ import annotations

import hashlib
import json
import random
from functools import cache

import pytest
from rosbags.typesys import Stores, get_typestore

from graphflow.msgs import registry
from graphflow.wire import idl
from graphflow.wire.schema import Message
from graphflow.wire.typehash import referenced, type_description, type_hash, type_id
from tests.cases import slow

from .messages import definitions

# Output of rosidl_generator_type_description, without the prefix.
TABLE = """
std_msgs/msg/String df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18
std_msgs/msg/Empty 20b625256f32d5dbc0d04fee44f43c41e51c70d3502f84b4a08e7a9c26a96312
std_msgs/msg/Char 3ad2d04dd29ba19d04b16659afa3ccaedd691914b02a64e82e252f2fa6a586a9
std_msgs/msg/Byte 41e1a3345f73fe93ede006da826a6ee274af23dd4653976ff249b0f44e3e798f
std_msgs/msg/Int32 b6578ded3c58c626cfe8d1a6fb6e04f706f97e9f03d2727c9ff4e74b1cef0deb
std_msgs/msg/Header f49fb3ae2cf070f793645ff749683ac6b06203e41c891e17701b1cb597ce6a01
std_msgs/msg/Float64MultiArray 1025ddc6b9552d191f89ef1a8d2f60f3d373e28b283d8891ddcc974e8c55397f
builtin_interfaces/msg/Time b106235e25a4c5ed35098aa0a61a3ee9c9b18d197f398b0e4206cea9acf9c197
unique_identifier_msgs/msg/UUID 1b8e8aca958cbea28fe6ef60bf6c19b683c97a9ef60bb34752067d0f2f7ab437
geometry_msgs/msg/Twist 9c45bf16fe0983d80e3cfe750d6835843d265a9a6c46bd2e609fcddde6fb8d2a
geometry_msgs/msg/TwistStamped 5f0fcd4f81d5d06ad9b4c4c63e3ea51b82d6ae4d0558f1d475229b1121db6f64
geometry_msgs/msg/PoseStamped 10f3786d7d40fd2b54367835614bff85d4ad3b5dab62bf8bca0cc232d73b4cd8
geometry_msgs/msg/TransformStamped 0a241f87d04668d94099cbb5ba11691d5ad32c2f29682e4eb5653424bd275206
sensor_msgs/msg/Image d31d41a9a4c4bc8eae9be757b0beed306564f7526c88ea6a4588fb9582527d47
sensor_msgs/msg/PointCloud2 9198cabf7da3796ae6fe19c4cb3bdd3525492988c70522628af5daa124bae2b5
sensor_msgs/msg/LaserScan 64c191398013af96509d518dac71d5164f9382553fce5c1f8cca5be7924bd828
sensor_msgs/msg/JointState a13ee3a330e346c9d87b5aa18d24e11690752bd33a0350f11c5882bc9179260e
sensor_msgs/msg/Imu 7d9a00ff131080897a5ec7e26e315954b8eae3353c3f995c55faf71574000b5b
sensor_msgs/msg/CompressedImage 15640771531571185e2efc8a100baf923961a4d15d5569652e6cb6691e8e371a
nav_msgs/msg/Odometry 3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0
tf2_msgs/msg/TFMessage e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087
rosgraph_msgs/msg/Clock 692f7a66e93a3c83e71765d033b60349ba68023a8c689a79e48078bcb5c58564
rcl_interfaces/msg/Log e28ce254ca8abc06abf92773b74602cdbf116ed34fbaf294fb9f81da9f318eac
rcl_interfaces/msg/ParameterEvent 043e627780fcad87a22d225bc2a037361dba713fca6a6b9f4b869a5aa0393204
action_msgs/msg/GoalStatusArray 6c1684b00f177d37438febe6e709fc4e2b0d4248dca4854946f9ed8b30cda83e
service_msgs/msg/ServiceEventInfo 41bcbbe07a75c9b52bc96bfd5c24d7f0fc0a08c0cb7921b3373c5732345a6f45
lifecycle_msgs/msg/TransitionEvent d5f8873a2f0146498f812d7885c7327ce27e463d36811d8792f35ee38c0d6c38
turtlesim/msg/Pose 739beba26bcba6920404ba722b7b8321348512f92ea5be235c47251940dd8aa9
example_interfaces/srv/AddTwoInts e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a
example_interfaces/srv/AddTwoInts_Request 000c5fd92d6b2e1a05949348f584d6d652adea1e92d691792011ac2273508302
example_interfaces/srv/AddTwoInts_Response de5c030d4af33cba2749310b249737b631594703f9300495f48bffb2b44dcc2f
example_interfaces/srv/AddTwoInts_Event 32c1d140259c71e5c355115942bcb31df98b4330e4d906b1b75ccb1c9b3ce6c8
std_srvs/srv/Empty 5888399dedec5ccc85ea6451949fd2c9f97bfdf963f9a588821639fcd31b5d19
std_srvs/srv/SetBool abe9e4bb6b41b40e6789712c00ec8871923e089af3f667a79992a428cff2da0a
std_srvs/srv/Trigger eeff2cd6fa5ad9d27cdf4dec64818317839b62f212a91e6b5304b634b2062c5f
rcl_interfaces/srv/GetParameters bf9803d5c74cf989a5de3e0c2e99444599a627c7ff75f97b8c05b01003675cbc
rcl_interfaces/srv/GetParameterTypes da199c878688b3e530bdfe3ca8f74cb9fa0c303101e980a9e8f260e25e1c80ca
rcl_interfaces/srv/SetParameters 56eed9a67e169f9cb6c1f987bc88f868c14a8fc9f743a263bc734c154015d7e0
rcl_interfaces/srv/SetParametersAtomically 0e192ef259c07fc3c07a13191d27002222e65e00ccec653ca05e856f79285fcd
rcl_interfaces/srv/DescribeParameters 845b484d71eb0673dae682f2e3ba3c4851a65a3dcfb97bddd82c5b57e91e4cff
rcl_interfaces/srv/ListParameters 3e6062bfbb27bfb8730d4cef2558221f51a11646d78e7bb30a1e83afac3aad9d
rcl_interfaces/srv/GetLoggerLevels 03bf1bebd0d6514c7ed0ba7c5e08dc9f2f39c759fe99e1e30ea4157d7674f72d
rcl_interfaces/srv/SetLoggerLevels 3ff86cb4e91fbf9abae15c234ecc874448de6ece8e193401c077cf116e4f6d78
type_description_interfaces/srv/GetTypeDescription 69b9c19c1021405984cc60dbbb1edceb147a6538b411d812ba6afabeed962cd5
lifecycle_msgs/srv/ChangeState 356fe34f0475a43acf54542013af4167b0e729f77ea22ffb045c6ad8e20668e5
lifecycle_msgs/srv/GetState 800a0a5aae599782b02932de0caf563f6dc4e7e94b794eadde075ba2cbef9795
lifecycle_msgs/srv/GetAvailableStates 00a07d79d2207d71e81a8cbc1880e5d924cc16d4688ea8e8e06e443dc8f8aa1d
lifecycle_msgs/srv/GetAvailableTransitions 59b7ecefce0982a8a844b9f2c4f14764c1c4543cc55e72924e2aa4adad83e9bc
composition_interfaces/srv/LoadNode 2e521ef6066fba6d7fc3a3b175d486709f01b4d738d9a59188858546fc8e5acd
turtlesim/srv/Spawn a71be24836f772debd6187dc8618cc47700d2602c7a3e2228bad67a8f5fd27b4
action_msgs/srv/CancelGoal 573d8b0a534451d7bc2ac8c5ffde8ac14b8593b7001175d0cd6516dcbeb8689a
example_interfaces/action/Fibonacci 9508051da1ea4658de144b09bd0690ff3de52104683d847aed764d2915906f51
example_interfaces/action/Fibonacci_Goal 226cb437e4355dcd3e914f930382a3b0cc1da81545bd319ed554e95a03255f51
example_interfaces/action/Fibonacci_Result fea81394f25aa4502217953f1a021fb750e79c10bbd43f13dd94632da6569649
example_interfaces/action/Fibonacci_Feedback 2b12e37361da6f408d4c85bc24a18de64333f29082f2ca34b5ee33dc4c8b42a9
example_interfaces/action/Fibonacci_SendGoal d1a57fb2a4afe8c21e34fb10db206f16ce6729b28531141472df92277c55b557
example_interfaces/action/Fibonacci_SendGoal_Request 3d088942b413247db536576f0286768c6be8fcd5d0c9a5d544f359fba090a238
example_interfaces/action/Fibonacci_SendGoal_Response d8c07bb3d5b766fe4b43159c9a5222af5214e2fcc29229b991d826166c512be1
example_interfaces/action/Fibonacci_SendGoal_Event d5e5b312dbf847307b0e876c2ecc9d80258e95b0d17f8f7bfc581c4a29c83484
example_interfaces/action/Fibonacci_GetResult 1b0de0d5d29dc955d92f546706568428632771db13ec84c15ec1c1a59f424a57
example_interfaces/action/Fibonacci_GetResult_Request c8a4f5e7d13b81286ee1043e2ecd084281cecf1ff06aaa799464f5f15479f003
example_interfaces/action/Fibonacci_GetResult_Response 6021dc98ab9b4bbe395e48aa4de81ee5f68eb570f88358affcc648146668b24f
example_interfaces/action/Fibonacci_GetResult_Event ac4e9cdb954c2e192c9f0753d46f59ab6f0101d5fb5b9542fd8ab2906e40c4d9
example_interfaces/action/Fibonacci_FeedbackMessage c1de71afd52e49a89c53d8262366884185bc0a02f78ce051c4e46b0a7fe59bb2
action_tutorials_interfaces/action/Fibonacci_GetResult 8b47e383f1e31f6d8df6417ab54957e7d5ea24dad315646ad711ac3fdea81d58
turtlesim/action/RotateAbsolute_SendGoal 0b9b876a15971456fbad2c7f0665c9879a41bb3fcba31a9015180a830f0ca84f
turtlesim/action/RotateAbsolute_GetResult 684206c4ffebeeab6f2134b42024d89cee3f496ad695eef4789ff0dc020c9f84
turtlesim/action/RotateAbsolute_FeedbackMessage 301a2a4ed96af28a40155e14dadf0c48eee5decaecd755be05ccda8144ca40b3
tf2_msgs/action/LookupTransform_SendGoal 4646ff5706c86b04d0a1098d329951a9731a7517e16702905de6073cc72c8530
test_msgs/msg/BasicTypes 7c300afd4e796798d49bdd6cdaa0fa87fa0ed2ba3217d977e1faa87070d797ab
test_msgs/msg/Strings eee55533636293ac7c94c62432eedb5777eb849847d2a17b4dcead8c4a20ab32
test_msgs/msg/WStrings 5a2c8ddb2054600023b9a180652f2ba895373217cad4b1f0fc1258c9e4424a79
test_msgs/msg/Arrays 8a321b80dae8c44dfd1ce558eaf1b1cd5ebbe5950863ed675836535511a7f91a
test_msgs/msg/BoundedSequences fb361a3b3827c76a142c2190126a20a92e7e510e047f880141a7e9ef867961ed
test_msgs/srv/BasicTypes da348697437c103cc9a9322ac1bdbdcf8eb11a85de22f7f2492ca1df416e1a5f
test_msgs/srv/BasicTypes_Event 5b9988a4805a06ae22dff12903a774ccda710e9514926b826ffc884e3a9a982e
test_messages/msg/MsgWithHeader 0be811aef59cf675e4afdd9dca7f4e5d70fc4a8dee741e2e8ada6003e46a966c
std_msgs/msg/ByteMultiArray 972fec7f50ab3c1d06783c228e79e8a9a509021708c511c059926261ada901d4
geometry_msgs/msg/Accel dc448243ded9b1fcbcca24aba0c22f013dae06c354ba2d849571c0a2a3f57ca0
turtlebot3_msgs/msg/SensorState e35bc7db55e7a7aeb24990b6d7f189a2002ae442e0d9925077e29895f838ccea
turtlebot3_msgs/srv/Dqn 7bf44771195bc4fc42a84cf1b43c94a06e5ec47e607b26f37232876efe4ae674
turtlebot3_msgs/action/Patrol_SendGoal 85fbfe77b5bdfd3b3fe877d3792f0aee7040b338e45e04316fdac171a87d428d
nav2_msgs/msg/Costmap d51bf7aecafdbb3f8f98215de648abe6d53f8db69156d6e143125d2ad2bf0027
nav2_msgs/msg/BehaviorTreeLog 9335ecb688a4f61b7eb82a7c10f23eea5f4e8bbdb7edfa048e3539aa928f51b7
nav2_msgs/srv/ManageLifecycleNodes 1850f4f677251bb8f7744e3c0a87ef4f66c205e2f8740a8330251af7d1804460
nav2_msgs/action/NavigateToPose_SendGoal a4fcb3bee1bf32e21a0e541a943b221aa0826996e2c98f079b47022b256f48b5
nav2_msgs/action/NavigateToPose_GetResult c407920357d566771e8882b4ef4d1f1a84ee922d609920ccd57faa6d6e391dc5
nav2_msgs/action/NavigateToPose_FeedbackMessage 9d1f6fa2eb975ce733b419ac2e97b134d8ff92b6478b6559feed9a50bdfd82b3
nav2_msgs/action/NavigateThroughPoses_SendGoal 5a590fa8e9a32b7b9c838fdf5939a2fb8858d6cfd25bdf2f2e5f0f7bbb25f52b
nav2_msgs/action/FollowGPSWaypoints_SendGoal 9b09aba9dd2612487fd37b5976e0735a54041b4873c9aa1e14508f981c39cfb5
gazebo_msgs/msg/ModelStates 948fbd9d345a298588ea99742362d651a73bdc46637dea1158bcadce859cb6f5
gazebo_msgs/srv/SpawnEntity a01b6c5a00d47ced8923b43e9e24764fcaa176d2eac6d88163cdb50a02f6cfb5
ros_gz_interfaces/msg/Contacts 2cf36dd51e105580839fb7d6c028846a6342a8dfd62fde733d05f3e0c9ec4b5b
ros_gz_interfaces/srv/SpawnEntity 5723a17a5fd50febee91c2f668058fbcbf3c91b66473196f16190f469e9a4e92
simulation_interfaces/msg/Result cf43a306adff3337a0a47143d8f5689933bc70a30478f13b077dc1fe3bc5ad17
simulation_interfaces/srv/GetEntities cb90004c48cd50f37732fb008e22c34c261dd680a723bf0f85d8437ea4498bf7
"""
HASHES = [line.split() for line in TABLE.split("\n") if line]

LYRICAL_TRANSITION_EVENT = """
builtin_interfaces/Time stamp
Transition transition
State start_state
State goal_state
"""


@pytest.mark.parametrize(("name", "digest"), HASHES)
def test_hash_is_upstreams(name: str, digest: str) -> None:
    """The hash of a message, service or action, or of a type derived from one, is the one ROS 2 computes."""
    assert registry.hash_of(name) == f"RIHS01_{digest}"


@cache
def in_rosbags(store: Stores) -> dict[str, str]:
    """Hashes by message name, as rosbags computes them from the definitions it carries."""
    types = get_typestore(store)
    return {name: types.hash_rihs01(name) for name in types.types}


def holds_char(name: str) -> bool:
    """Whether a `char` is somewhere in the message: rosbags gives it another number than the specification."""
    message = registry.message_schema(name)
    parts = [message, *referenced(message, registry.message_schema).values()]
    return any(field.type.base == "char" for part in parts for field in part.fields)


@slow
@pytest.mark.parametrize(
    ("profile", "store"),
    [("jazzy", Stores.ROS2_JAZZY), ("kilted", Stores.ROS2_KILTED), ("lyrical", Stores.ROS2_LYRICAL)],
)
def test_every_message_of_a_distribution_has_its_hash(
    profile: str, store: Stores, monkeypatch: pytest.MonkeyPatch, fresh_registry: None
) -> None:
    """Every message that rosbags knows of a distribution is bundled, and its hash is the one rosbags computes."""
    monkeypatch.setenv("GRAPHFLOW_WIRE", profile)
    theirs = in_rosbags(store)
    assert len(theirs) > 160
    differ = {name for name, digest in theirs.items() if registry.hash_of(name) != digest}
    assert differ == {name for name in theirs if holds_char(name)}
    assert len(differ) == {"jazzy": 5, "kilted": 5, "lyrical": 5}[profile]


def test_hash_follows_the_definition() -> None:
    """One name with another definition, as ROS 2 Lyrical has it, gets that definition's hash."""
    event = idl.parse("lifecycle_msgs/msg/TransitionEvent", LYRICAL_TRANSITION_EVENT)
    assert isinstance(event, Message)
    digest = "78b19e2be41a797fc009c96bda68944182edabec7852cccd928a40bc06f6f9d7"
    assert type_hash(event, registry.message_schema) == f"RIHS01_{digest}"


def test_description_is_upstreams_text() -> None:
    """The text that is hashed is the JSON of the specification, to the letter."""
    assert type_description(registry.message_schema("std_msgs/msg/String"), registry.message_schema) == (
        '{"type_description": {"type_name": "std_msgs/msg/String", "fields": [{"name": "data", "type": '
        '{"type_id": 17, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}}]}, '
        '"referenced_type_descriptions": []}'
    )


def test_hash_is_of_the_description() -> None:
    """The hash is SHA-256 of the description, behind a prefix."""
    text = type_description(registry.message_schema("geometry_msgs/msg/Twist"), registry.message_schema)
    assert registry.hash_of("geometry_msgs/msg/Twist") == "RIHS01_" + hashlib.sha256(text.encode()).hexdigest()


def test_references_are_transitive_sorted_and_single() -> None:
    """Every type within, at any depth, is described once, in the order of the names, and the type itself is not."""
    schema = registry.message_schema("nav_msgs/msg/Odometry")
    names = [
        t["type_name"]
        for t in json.loads(type_description(schema, registry.message_schema))["referenced_type_descriptions"]
    ]
    assert names == [
        "builtin_interfaces/msg/Time",
        "geometry_msgs/msg/Point",
        "geometry_msgs/msg/Pose",
        "geometry_msgs/msg/PoseWithCovariance",
        "geometry_msgs/msg/Quaternion",
        "geometry_msgs/msg/Twist",
        "geometry_msgs/msg/TwistWithCovariance",
        "geometry_msgs/msg/Vector3",
        "std_msgs/msg/Header",
    ]
    assert sorted(referenced(schema, registry.message_schema)) == names


@pytest.mark.parametrize(
    ("text", "number", "capacity", "string_capacity", "nested"),
    [
        ("int8", 2, 0, 0, ""),
        ("uint8", 3, 0, 0, ""),
        ("char", 3, 0, 0, ""),
        ("int16", 4, 0, 0, ""),
        ("uint16", 5, 0, 0, ""),
        ("int32", 6, 0, 0, ""),
        ("uint32", 7, 0, 0, ""),
        ("int64", 8, 0, 0, ""),
        ("uint64", 9, 0, 0, ""),
        ("float32", 10, 0, 0, ""),
        ("float64", 11, 0, 0, ""),
        ("bool", 15, 0, 0, ""),
        ("byte", 16, 0, 0, ""),
        ("string", 17, 0, 0, ""),
        ("wstring", 18, 0, 0, ""),
        ("string<=5", 21, 0, 5, ""),
        ("wstring<=12", 22, 0, 12, ""),
        ("string<=12[22]", 69, 22, 12, ""),
        ("string[<=32]", 113, 32, 0, ""),
        ("float64[3]", 59, 3, 0, ""),
        ("float64[]", 155, 0, 0, ""),
        ("other_pkg/RefThing", 1, 0, 0, "other_pkg/msg/RefThing"),
        ("other_pkg/RefThing[]", 145, 0, 0, "other_pkg/msg/RefThing"),
        ("RefThing[<=1]", 97, 1, 0, "pkg/msg/RefThing"),
    ],
)
def test_field_types_are_described(text: str, number: int, capacity: int, string_capacity: int, nested: str) -> None:
    """Each kind of field type has the number, the capacities and the nested name that upstream gives it."""
    schema = idl.parse("pkg/msg/Holder", f"{text} field")
    assert isinstance(schema, Message)
    described = json.loads(type_description(schema, Message))["type_description"]["fields"][0]["type"]
    assert described == {
        "type_id": number,
        "capacity": capacity,
        "string_capacity": string_capacity,
        "nested_type_name": nested,
    }
    assert type_id(idl.parse_type(text, "pkg")) == number


def test_a_type_without_fields_has_one_hidden_byte() -> None:
    """An empty type is described with the one byte that stands for it on the wire."""
    described = json.loads(type_description(Message("pkg/msg/Empty"), Message))["type_description"]["fields"]
    assert [(f["name"], f["type"]["type_id"]) for f in described] == [("structure_needs_at_least_one_member", 3)]


def test_defaults_constants_and_comments_do_not_enter() -> None:
    """Only names and types decide the hash."""
    bare = idl.parse("pkg/msg/A", "int32 x\nstring<=4 s")
    dressed = idl.parse("pkg/msg/A", "# about\nint32 LIMIT=3\nint32 x 7 # metres\n\nstring<=4 s 'four'")
    assert isinstance(bare, Message)
    assert isinstance(dressed, Message)
    assert type_hash(bare, Message) == type_hash(dressed, Message)


@pytest.mark.parametrize(
    "other",
    [
        "int32 y\nint32 x",
        "int32 x\nint64 y",
        "int32 x\nint32 z",
        "int32 x",
        "int32 x\nint32[] y",
        "int32 x\nint32[2] y",
        "int32 x\nint32[<=2] y",
    ],
)
def test_names_types_and_order_enter(other: str) -> None:
    """Another name, type, size or order of fields is another hash."""
    first, second = idl.parse("pkg/msg/A", "int32 x\nint32 y"), idl.parse("pkg/msg/A", other)
    assert isinstance(first, Message)
    assert isinstance(second, Message)
    assert type_hash(first, Message) != type_hash(second, Message)


def test_every_interface_has_a_hash_of_its_own() -> None:
    """No two of the known interfaces share a hash, whichever order they are asked in."""
    names = list(definitions())
    random.Random(1).shuffle(names)
    assert len({registry.hash_of(name) for name in names}) == len(names)
