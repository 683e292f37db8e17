"""What a type checker lets through and refuses about messages. Checked, never called: an unused ignore is a failure."""

from typing import TypeVar, assert_type

import numpy as np
import numpy.typing as npt

from graphflow import times
from graphflow.msgs.base import Action, Message, Service
from graphflow.msgs.builtin_interfaces.msg import Duration, Time
from graphflow.msgs.example_interfaces.action import Fibonacci, Fibonacci_Feedback, Fibonacci_Goal, Fibonacci_Result
from graphflow.msgs.example_interfaces.srv import AddTwoInts, AddTwoInts_Request, AddTwoInts_Response
from graphflow.msgs.geometry_msgs.msg import Point, Polygon, PoseArray, PoseWithCovariance, Twist, Vector3
from graphflow.msgs.rcl_interfaces.msg import ListParametersResult, Log, ParameterValue
from graphflow.msgs.std_msgs.msg import Byte, Float32MultiArray, Header, Int32MultiArray, String, UInt8MultiArray
from graphflow.msgs.turtlesim_msgs.msg import Pose
from graphflow.msgs.turtlesim_msgs.srv import Spawn
from graphflow.msgs.unique_identifier_msgs.msg import UUID

M = TypeVar("M", bound=Message)
Req = TypeVar("Req", bound=Message)
Res = TypeVar("Res", bound=Message)
G = TypeVar("G", bound=Message)
R = TypeVar("R", bound=Message)
F = TypeVar("F", bound=Message)


def attributes(twist: Twist, poses: PoseArray, names: ListParametersResult, value: ParameterValue) -> None:
    assert_type(twist.linear, Vector3)
    assert_type(twist.linear.x, float)
    assert_type(poses.header, Header)
    assert_type(poses.header.stamp.sec, int)
    assert_type(poses.poses[0].position, Point)
    assert_type(names.names, list[str])
    assert_type(value.type, int)
    assert_type(value.bool_array_value, npt.NDArray[np.bool_])
    assert_type(value.byte_array_value, npt.NDArray[np.uint8])
    assert_type(value.double_array_value, npt.NDArray[np.float64])
    twist.linear.x = 1
    twist.linear.x = "1"  # type: ignore[assignment]
    twist.linear = {"x": 1.0}  # type: ignore[assignment]
    twist.lineal  # type: ignore[attr-defined]  # noqa: B018


def scalars() -> None:
    Vector3(x=1, y=2.5)
    Pose(x=1.0, theta=np.float64(0.5))
    String(data="hello")
    Byte(data=b"x")
    Vector3(x="1")  # type: ignore[arg-type]
    Vector3(w=1.0)  # type: ignore[call-arg]
    Vector3(1.0)  # type: ignore[call-arg]
    String(data=b"hello")  # type: ignore[arg-type]
    AddTwoInts.Request(a=1.5)  # type: ignore[arg-type]


def nested(stamp: times.Time, span: times.Duration) -> None:
    Twist(linear=Vector3(x=1.0), angular={"z": 0.5})
    Twist(linear=Point())  # type: ignore[arg-type]
    Twist(linear=1.0)  # type: ignore[arg-type]
    Header(stamp=stamp, frame_id="map")
    Header(stamp=Time(sec=1))
    Header(stamp={"sec": 1})
    Header(stamp=span)  # type: ignore[arg-type]
    Header(stamp=Duration())  # type: ignore[arg-type]


def arrays(doubles: npt.NDArray[np.float64], integers: npt.NDArray[np.int64], text: npt.NDArray[np.str_]) -> None:
    PoseWithCovariance(covariance=[0] * 36)
    PoseWithCovariance(covariance=(0.0,) * 36)
    PoseWithCovariance(covariance=np.eye(6).ravel())
    Float32MultiArray(data=doubles)
    Float32MultiArray(data=integers)
    Float32MultiArray(data=text)  # type: ignore[arg-type]
    Float32MultiArray(data="123")  # type: ignore[arg-type]
    Float32MultiArray(data=1.0)  # type: ignore[arg-type]
    Int32MultiArray(data=range(3))
    Int32MultiArray(data=integers)
    Int32MultiArray(data=doubles)  # type: ignore[arg-type]
    Int32MultiArray(data=[1.5])  # type: ignore[list-item]
    UInt8MultiArray(data=b"raw")
    UInt8MultiArray(data=bytearray(3))
    UInt8MultiArray(data=memoryview(b"raw"))
    UUID(uuid=bytes(16))
    ParameterValue(bool_array_value=[True, False])
    ParameterValue(bool_array_value=integers)  # type: ignore[arg-type]


def lists(points: list[Point]) -> None:
    Polygon(points=[{"x": 1.0}, {"y": 2.0}])
    Polygon(points=())
    Polygon(points=points)  # type: ignore[arg-type]
    ListParametersResult(names=("a", "b"))
    ListParametersResult(names=[1])  # type: ignore[list-item]


def constants() -> None:
    Log(level=Log.WARN)
    Log.WARN = 1  # type: ignore[assignment]


def add(request: AddTwoInts.Request) -> AddTwoInts.Response:
    assert_type(request, AddTwoInts_Request)
    AddTwoInts.Event(request=[request])
    return AddTwoInts.Response(sum=request.a + request.b)


def call(kind: type[Service[Req, Res]], request: Req) -> Res:
    raise NotImplementedError


def send_goal(kind: type[Action[G, R, F]], goal: G) -> tuple[R, F]:
    raise NotImplementedError


def publish(kind: type[M], message: M) -> M:
    raise NotImplementedError


def parts_follow_from_the_class() -> None:
    assert_type(call(AddTwoInts, AddTwoInts.Request(a=1, b=2)), AddTwoInts_Response)
    assert_type(call(Spawn, Spawn.Request(x=1)).name, str)
    call(AddTwoInts, Spawn.Request())  # type: ignore[misc]
    assert_type(send_goal(Fibonacci, Fibonacci.Goal(order=3)), tuple[Fibonacci_Result, Fibonacci_Feedback])
    send_goal(Fibonacci, Fibonacci.Result())  # type: ignore[misc]
    assert_type(Fibonacci.Goal(), Fibonacci_Goal)
    assert_type(publish(Twist, Twist()), Twist)
    assert_type(Twist.from_bytes(b""), Twist)


def parts_are_types(goal: Fibonacci.Goal, result: Fibonacci.Result, feedback: Fibonacci.Feedback) -> None:
    assert_type(goal.order, int)
    assert_type(result.sequence, npt.NDArray[np.int32])
    assert_type(feedback.sequence, npt.NDArray[np.int32])
