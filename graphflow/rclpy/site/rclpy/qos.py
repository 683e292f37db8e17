"""Quality of service: the profile that a publisher offers, and that a subscription requests."""

from __future__ import annotations

import warnings
from enum import Enum, IntEnum
from typing import Any, Self

from graphflow.qos import INFINITE_NS, Durability, History, Liveliness, Qos, Reliability
from rclpy.duration import Duration
from rclpy.impl.callers import stack_level
from rclpy.impl.mistakes import swapped_policies

_BEST_AVAILABLE_NS = 2**63 - 2  # rmw's number: one less than its infinite
_POLICIES = (
    *("history", "depth", "reliability", "durability", "lifespan", "deadline", "liveliness"),
    *("liveliness_lease_duration", "avoid_ros_namespace_conventions"),
)


class QoSPolicyKind(IntEnum):
    """The policies, by number."""

    INVALID = 1
    DURABILITY = 2
    DEADLINE = 4
    LIVELINESS = 8
    RELIABILITY = 16
    HISTORY = 32
    LIFESPAN = 64
    DEPTH = 128
    LIVELINESS_LEASE_DURATION = 256
    AVOID_ROS_NAMESPACE_CONVENTIONS = 512


def qos_policy_name_from_kind(policy_kind: QoSPolicyKind | int) -> str:
    """Return the name of a policy."""
    return QoSPolicyKind(policy_kind).name


class InvalidQoSProfileException(Exception):
    """A profile is incomplete."""

    def __init__(self, *args: object) -> None:
        super().__init__("Invalid QoSProfile", *args)


class QoSPolicyEnum(IntEnum):
    """The base class of policy enumerations, whose values also have short names."""

    @classmethod
    def short_keys(cls) -> list[str]:
        """Return the short names: `reliable`, `best_effort`."""
        return [name.lower() for name in cls.__members__ if not name.startswith("RMW")]

    @classmethod
    def get_from_short_key(cls, name: str) -> Self:
        """Return the value of a short name. Raises KeyError if there is none."""
        return cls[name.upper()]

    @property
    def short_key(self) -> str:
        return self.name.lower()


class HistoryPolicy(QoSPolicyEnum):
    """The messages that are kept."""

    SYSTEM_DEFAULT = 0
    KEEP_LAST = 1
    KEEP_ALL = 2
    UNKNOWN = 3


class ReliabilityPolicy(QoSPolicyEnum):
    """Whether lost messages are sent again."""

    SYSTEM_DEFAULT = 0
    RELIABLE = 1
    BEST_EFFORT = 2
    UNKNOWN = 3
    BEST_AVAILABLE = 4


class DurabilityPolicy(QoSPolicyEnum):
    """Whether late subscriptions receive earlier messages."""

    SYSTEM_DEFAULT = 0
    TRANSIENT_LOCAL = 1
    VOLATILE = 2
    UNKNOWN = 3
    BEST_AVAILABLE = 4


class LivelinessPolicy(QoSPolicyEnum):
    """The way in which a publisher shows that it is alive."""

    SYSTEM_DEFAULT = 0
    AUTOMATIC = 1
    MANUAL_BY_TOPIC = 3  # 2 is rmw's deprecated MANUAL_BY_NODE
    UNKNOWN = 4
    BEST_AVAILABLE = 5


class _FormerName:
    """A value under its name from ROS 2's first versions; using it warns."""

    def __init__(self, former: str, name: str) -> None:
        self._former, self._name = former, name

    def __get__(self, value: object, policy: type[QoSPolicyEnum]) -> QoSPolicyEnum:
        warnings.warn(f"{self._former} is deprecated; it is {policy.__name__}.{self._name} now", stacklevel=2)
        return policy[self._name]


def _know_former_names(policy: type[QoSPolicyEnum]) -> None:
    for name in policy.__members__:
        former = f"RMW_QOS_POLICY_{policy.__name__.removesuffix('Policy').upper()}_{name}"
        setattr(policy, former, _FormerName(former, name))


for _each in (HistoryPolicy, ReliabilityPolicy, DurabilityPolicy, LivelinessPolicy):
    _know_former_names(_each)

QoSHistoryPolicy = HistoryPolicy
QoSReliabilityPolicy = ReliabilityPolicy
QoSDurabilityPolicy = DurabilityPolicy
QoSLivelinessPolicy = LivelinessPolicy


def _mismatch(name: str, kind: type, value: object) -> str:
    """Show what to write instead of a value of the wrong type."""
    way = f"{kind.__name__}(seconds={value})" if kind is Duration else "10" if kind is int else ""
    if issubclass(kind, Enum):
        members = [member.name for member in kind]
        way = f"{kind.__name__}.{str(value).upper() if str(value).upper() in members else members[1]}"
    return f"{name} must be {'a' if kind is not int else 'an'} {kind.__name__}, got {value!r}: write {way}"


class QoSProfile:
    """The QoS policies of one endpoint.

    Args:
        kwargs: Policies by name; with KEEP_LAST, or no `history`, a `depth` must be given.

    Raises:
        InvalidQoSProfileException: Neither history nor depth is given, or KEEP_LAST without a depth.
        AssertionError: A value is of the wrong type, or a keyword is not a policy.
    """

    __slots__ = tuple(f"_{name}" for name in _POLICIES)

    _depth: int
    _lifespan: Duration
    _deadline: Duration
    _liveliness_lease_duration: Duration
    _avoid_ros_namespace_conventions: bool
    _history: HistoryPolicy
    _reliability: ReliabilityPolicy
    _durability: DurabilityPolicy
    _liveliness: LivelinessPolicy

    def __init__(self, **kwargs: Any) -> None:
        wrong = [word for word in kwargs if word not in _POLICIES]
        assert not wrong, f"Invalid arguments passed to constructor: {wrong}"
        if "history" not in kwargs:
            if "depth" not in kwargs:
                raise InvalidQoSProfileException("History and/or depth settings are required.")
            kwargs["history"] = HistoryPolicy.KEEP_LAST
        if kwargs["history"] == HistoryPolicy.KEEP_LAST and "depth" not in kwargs:
            raise InvalidQoSProfileException("History set to KEEP_LAST without a depth setting.")
        # First, since the setter of `depth` reads it.
        self.history = kwargs["history"]
        self.depth = kwargs.get("depth", 0)
        self.reliability = kwargs.get("reliability", ReliabilityPolicy.RELIABLE)
        self.durability = kwargs.get("durability", DurabilityPolicy.VOLATILE)
        self.lifespan = kwargs.get("lifespan", Duration())
        self.deadline = kwargs.get("deadline", Duration())
        self.liveliness = kwargs.get("liveliness", LivelinessPolicy.SYSTEM_DEFAULT)
        self.liveliness_lease_duration = kwargs.get("liveliness_lease_duration", Duration())
        self.avoid_ros_namespace_conventions = kwargs.get("avoid_ros_namespace_conventions", False)

    @property
    def history(self) -> HistoryPolicy:
        return self._history

    @history.setter
    def history(self, value: HistoryPolicy) -> None:
        # Assertions, as in rclpy's setters.
        assert isinstance(value, (HistoryPolicy, int)), _mismatch("history", HistoryPolicy, value)
        self._history = HistoryPolicy(value)
        swapped_policies.check("history", value, self._history)

    @property
    def reliability(self) -> ReliabilityPolicy:
        return self._reliability

    @reliability.setter
    def reliability(self, value: ReliabilityPolicy) -> None:
        assert isinstance(value, (ReliabilityPolicy, int)), _mismatch("reliability", ReliabilityPolicy, value)
        self._reliability = ReliabilityPolicy(value)
        swapped_policies.check("reliability", value, self._reliability)

    @property
    def durability(self) -> DurabilityPolicy:
        return self._durability

    @durability.setter
    def durability(self, value: DurabilityPolicy) -> None:
        assert isinstance(value, (DurabilityPolicy, int)), _mismatch("durability", DurabilityPolicy, value)
        self._durability = DurabilityPolicy(value)
        swapped_policies.check("durability", value, self._durability)

    @property
    def depth(self) -> int:
        return self._depth

    @depth.setter
    def depth(self, value: int) -> None:
        assert isinstance(value, int), _mismatch("depth", int, value)
        if self.history == HistoryPolicy.KEEP_LAST and value == 0:
            warnings.warn(
                "A zero depth with KEEP_LAST doesn't make sense; no data could be stored. "
                "This will be interpreted as SYSTEM_DEFAULT: write a depth, such as 10",
                stacklevel=stack_level(),
            )
        if value < 0:
            raise ValueError("Depth must be greater than or equal to zero")
        self._depth = value
        # `value + 0` makes a plain int of an enumeration's value, as which it will be read.
        swapped_policies.check("depth", value, value + 0)

    @property
    def lifespan(self) -> Duration:
        return self._lifespan

    @lifespan.setter
    def lifespan(self, value: Duration) -> None:
        assert isinstance(value, Duration), _mismatch("lifespan", Duration, value)
        self._lifespan = value

    @property
    def deadline(self) -> Duration:
        return self._deadline

    @deadline.setter
    def deadline(self, value: Duration) -> None:
        assert isinstance(value, Duration), _mismatch("deadline", Duration, value)
        self._deadline = value

    @property
    def liveliness(self) -> LivelinessPolicy:
        return self._liveliness

    @liveliness.setter
    def liveliness(self, value: LivelinessPolicy) -> None:
        assert isinstance(value, (LivelinessPolicy, int)), _mismatch("liveliness", LivelinessPolicy, value)
        self._liveliness = LivelinessPolicy(value)
        swapped_policies.check("liveliness", value, self._liveliness)

    @property
    def liveliness_lease_duration(self) -> Duration:
        return self._liveliness_lease_duration

    @liveliness_lease_duration.setter
    def liveliness_lease_duration(self, value: Duration) -> None:
        assert isinstance(value, Duration), _mismatch("liveliness_lease_duration", Duration, value)
        self._liveliness_lease_duration = value

    @property
    def avoid_ros_namespace_conventions(self) -> bool:
        return self._avoid_ros_namespace_conventions

    @avoid_ros_namespace_conventions.setter
    def avoid_ros_namespace_conventions(self, value: bool) -> None:
        assert isinstance(value, bool)
        self._avoid_ros_namespace_conventions = value

    def to_dict(self) -> dict[str, Any]:
        """Return the policies by name."""
        return {name: getattr(self, name) for name in _POLICIES}

    def get_c_qos_profile(self) -> QoSProfile:
        """Return the profile itself; rclpy's internal handle has no equivalent."""
        return self

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, QoSProfile):
            return False
        return all(getattr(self, slot) == getattr(other, slot) for slot in self.__slots__)

    __hash__ = None  # type: ignore[assignment]  # profiles can change

    def __str__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{name}={getattr(self, name)}' for name in _POLICIES)})"


DeadlineBestAvailable = Duration(nanoseconds=_BEST_AVAILABLE_NS)
LivelinessLeaseDurationeBestAvailable = Duration(nanoseconds=_BEST_AVAILABLE_NS)  # rclpy's spelling


def _profile(depth: int, **policies: object) -> QoSProfile:
    return QoSProfile(history=policies.pop("history", HistoryPolicy.KEEP_LAST), depth=depth, **policies)


qos_profile_unknown = _profile(
    0,
    history=HistoryPolicy.UNKNOWN,
    reliability=ReliabilityPolicy.UNKNOWN,
    durability=DurabilityPolicy.UNKNOWN,
    liveliness=LivelinessPolicy.UNKNOWN,
)
qos_profile_default = _profile(10)
qos_profile_system_default = _profile(
    0,
    history=HistoryPolicy.SYSTEM_DEFAULT,
    reliability=ReliabilityPolicy.SYSTEM_DEFAULT,
    durability=DurabilityPolicy.SYSTEM_DEFAULT,
)
qos_profile_sensor_data = _profile(5, reliability=ReliabilityPolicy.BEST_EFFORT)
qos_profile_services_default = _profile(10)
qos_profile_parameters = _profile(1000)
qos_profile_parameter_events = _profile(1000)
qos_profile_rosout_default = _profile(1000, durability=DurabilityPolicy.TRANSIENT_LOCAL, lifespan=Duration(seconds=10))
qos_profile_best_available = _profile(
    10,
    reliability=ReliabilityPolicy.BEST_AVAILABLE,
    durability=DurabilityPolicy.BEST_AVAILABLE,
    deadline=DeadlineBestAvailable,
    liveliness=LivelinessPolicy.BEST_AVAILABLE,
    liveliness_lease_duration=LivelinessLeaseDurationeBestAvailable,
)
qos_profile_action_status_default = _profile(1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class QoSPresetProfiles(Enum):
    """The predefined profiles."""

    UNKNOWN = qos_profile_unknown
    DEFAULT = qos_profile_default
    SYSTEM_DEFAULT = qos_profile_system_default
    SENSOR_DATA = qos_profile_sensor_data
    SERVICES_DEFAULT = qos_profile_services_default
    PARAMETERS = qos_profile_parameters
    PARAMETER_EVENTS = qos_profile_parameter_events
    ACTION_STATUS_DEFAULT = qos_profile_action_status_default
    BEST_AVAILABLE = qos_profile_best_available

    @classmethod
    def short_keys(cls) -> list[str]:
        """Return the names in lower case."""
        return [name.lower() for name in cls.__members__]

    @classmethod
    def get_from_short_key(cls, name: str) -> QoSProfile:
        """Return the profile of a name. Raises KeyError if there is none."""
        return cls[name.upper()].value


class QoSCompatibility(IntEnum):
    """Whether a publisher and a subscription would match."""

    OK = 0
    WARNING = 1
    ERROR = 2


_UNDECIDED = ("SYSTEM_DEFAULT", "UNKNOWN", "BEST_AVAILABLE")


def qos_check_compatible(publisher_qos: QoSProfile, subscription_qos: QoSProfile) -> tuple[QoSCompatibility, str]:
    """Check whether a publisher's messages would reach a subscription under DDS, and give the reason if not."""
    errors, warned = [], []

    def compare(what: str, offered: Any, wanted: Any, weak: str, strong: str) -> None:
        if offered.name == weak and wanted.name == strong:
            errors.append(f"ERROR: {weak.replace('_', ' ').title()} publisher and {strong.lower()} subscription;")
        elif (offered.name in _UNDECIDED and wanted.name == strong) or (
            offered.name == weak and wanted.name in _UNDECIDED
        ):
            warned.append(f"WARNING: {what} of the publisher or the subscription is not known;")

    compare("reliability", publisher_qos.reliability, subscription_qos.reliability, "BEST_EFFORT", "RELIABLE")
    compare("durability", publisher_qos.durability, subscription_qos.durability, "VOLATILE", "TRANSIENT_LOCAL")
    compare("liveliness", publisher_qos.liveliness, subscription_qos.liveliness, "AUTOMATIC", "MANUAL_BY_TOPIC")
    for what in ("deadline", "liveliness_lease_duration"):
        offered, wanted = getattr(publisher_qos, what).nanoseconds, getattr(subscription_qos, what).nanoseconds
        if wanted and not offered:
            errors.append(f"ERROR: Subscription has a {what}, but publisher does not;")
        elif wanted and offered > wanted:
            errors.append(f"ERROR: Subscription {what} is less than publisher {what};")
    if errors:
        return QoSCompatibility.ERROR, " ".join(errors)
    return (QoSCompatibility.WARNING, " ".join(warned)) if warned else (QoSCompatibility.OK, "")


def to_graphflow(profile: QoSProfile) -> Qos:
    """Convert a profile to graphflow's. Values that are system defaults, or unknown, become graphflow's default."""

    def span(duration: Duration) -> int:
        return INFINITE_NS if duration.nanoseconds in (0, _BEST_AVAILABLE_NS) else duration.nanoseconds

    def chosen(kind: type[Any], value: IntEnum, otherwise: object) -> Any:
        return next((member for member in kind if member.value == value), otherwise)

    return Qos(
        profile.depth,
        chosen(Reliability, profile.reliability, Reliability.RELIABLE),
        chosen(Durability, profile.durability, Durability.VOLATILE),
        chosen(History, profile.history, History.KEEP_LAST),
        span(profile.deadline),
        span(profile.lifespan),
        chosen(Liveliness, profile.liveliness, Liveliness.AUTOMATIC),
        span(profile.liveliness_lease_duration),
    )


def from_graphflow(qos: Qos) -> QoSProfile:
    """Convert an announced profile of graphflow's."""

    def span(nanoseconds: int) -> Duration:
        return Duration(nanoseconds=nanoseconds)

    return QoSProfile(
        history=HistoryPolicy(qos.history),
        depth=qos.depth,
        reliability=ReliabilityPolicy(qos.reliability),
        durability=DurabilityPolicy(qos.durability),
        lifespan=span(qos.lifespan_ns),
        deadline=span(qos.deadline_ns),
        liveliness=LivelinessPolicy(qos.liveliness),
        liveliness_lease_duration=span(qos.lease_ns),
    )


def validated(qos_profile: QoSProfile | int) -> QoSProfile:
    """Return the profile, or the default one with a depth. Raises ValueError for a negative depth, else TypeError."""
    if isinstance(qos_profile, QoSProfile):
        return qos_profile
    if isinstance(qos_profile, int):
        if qos_profile < 0:
            raise ValueError("history depth must be greater than or equal to zero")
        return QoSProfile(depth=int(qos_profile))
    raise TypeError(f"Expected QoSProfile or int, but received {type(qos_profile)!r}")
