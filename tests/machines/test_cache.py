"""The picture of the graph that tokens draw."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from graphflow.machines import cache as cache_module
from graphflow.machines.cache import GraphCache, GraphChange
from graphflow.wire.liveliness import Entity, Kind, parse_token
from tests.cases import slow

STRING = "std_msgs/msg/String"
ADD = "example_interfaces/srv/AddTwoInts"


def node(name: str, zid: str = "a", nid: int = 0, namespace: str = "/") -> Entity:
    return Entity(0, zid, nid, nid, Kind.NODE, namespace, name)


def endpoint(of: Entity, eid: int, kind: Kind, name: str, type_: str = STRING) -> Entity:
    return Entity(0, of.zid, of.nid, eid, kind, of.namespace, of.node, name, type_, "RIHS01_0")


TALKER = node("talker")
CHATTER = endpoint(TALKER, 1, Kind.PUBLISHER, "/chatter")
LISTENER = node("listener", "b", namespace="/robot")
HEARD = endpoint(LISTENER, 1, Kind.SUBSCRIPTION, "/chatter")
SERVER = endpoint(LISTENER, 2, Kind.SERVICE, "/add", ADD)
GRAPH = [TALKER, CHATTER, LISTENER, HEARD, SERVER]


def cache_of(*entities: Entity) -> GraphCache:
    return GraphCache(e.token for e in entities)


@given(st.permutations(GRAPH))
def test_the_order_of_arrival_does_not_matter(order: list[Entity]) -> None:
    """Whatever comes first, the picture is the same."""
    cache = cache_of(*order)

    assert cache.nodes() == ["/robot/listener", "/talker"]
    assert cache.topics() == {"/chatter": [STRING]}
    assert cache.services() == {"/add": [ADD]}
    assert cache.endpoints(Kind.SUBSCRIPTION, "/chatter") == [HEARD]


def test_a_token_changes_the_picture_once() -> None:
    """A repeated token is no change, neither when it comes nor when it goes."""
    cache = GraphCache()

    assert cache.apply(CHATTER.token, alive=True) == [GraphChange(CHATTER, True)]
    assert cache.apply(CHATTER.token, alive=True) == []
    assert CHATTER.token in cache
    assert cache.apply(CHATTER.token, alive=False) == [GraphChange(CHATTER, False)]
    assert cache.apply(CHATTER.token, alive=False) == []
    assert CHATTER.token not in cache


@pytest.mark.parametrize("token", ["", "nonsense", "@ros2_lv/0/a/0/0/XX/%/%/talker", "@graphflow/0/proc/a/0/1"])
def test_an_unknown_token_is_left_alone(token: str) -> None:
    """What cannot be read as an entity is no entity, alive or not."""
    cache = GraphCache()

    assert cache.apply(token, alive=True) == []
    assert cache.apply(token, alive=False) == []
    assert list(cache) == []


def test_the_end_of_a_node_ends_its_endpoints() -> None:
    """A node's endpoints go with it and are reported, and those of others stay."""
    cache = cache_of(*GRAPH)

    changes = cache.apply(LISTENER.token, alive=False)

    assert changes[0] == GraphChange(LISTENER, False)
    assert set(changes[1:]) == {GraphChange(HEARD, False), GraphChange(SERVER, False)}
    assert set(cache) == {TALKER, CHATTER}
    assert cache.apply(HEARD.token, alive=False) == []


def test_a_node_is_known_from_its_endpoints() -> None:
    """An endpoint whose node's token is still on its way shows the node."""
    assert cache_of(CHATTER).nodes() == ["/talker"]


def test_twins_are_two_nodes() -> None:
    """Nodes that share a name appear as often as they are, and one's end leaves the other's endpoints."""
    twin = node("talker", "b", 7)
    other = endpoint(twin, 8, Kind.PUBLISHER, "/chatter")
    cache = cache_of(TALKER, CHATTER, twin, other)

    assert cache.nodes() == ["/talker", "/talker"]
    assert cache.owners("/talker") == [TALKER, twin]

    cache.apply(TALKER.token, alive=False)

    assert cache.nodes() == ["/talker"]
    assert cache.endpoints(Kind.PUBLISHER) == [other]


def test_nodes_of_one_session_are_apart() -> None:
    """The end of one node of a process leaves the other nodes of that process alone."""
    second = node("second", "a", 5)
    held = endpoint(second, 6, Kind.PUBLISHER, "/other")
    cache = cache_of(TALKER, CHATTER, second, held)

    cache.apply(TALKER.token, alive=False)

    assert set(cache) == {second, held}


def test_hidden_names_are_left_out_of_listings() -> None:
    """A part that begins with an underscore hides topic, service and node, unless they are asked for."""
    tool = node("_tool", "c")
    hidden = endpoint(tool, 1, Kind.PUBLISHER, "/a/_b/c")
    service = endpoint(tool, 2, Kind.SERVICE, "/_secret", ADD)
    cache = cache_of(TALKER, CHATTER, tool, hidden, service)

    assert cache.nodes(hidden=False) == ["/talker"]
    assert cache.nodes() == ["/_tool", "/talker"]
    assert cache.topics() == {"/chatter": [STRING]}
    assert cache.topics(hidden=True) == {"/a/_b/c": [STRING], "/chatter": [STRING]}
    assert cache.services() == {}
    assert cache.services(hidden=True) == {"/_secret": [ADD]}


def test_a_topic_has_all_the_types_it_is_used_with() -> None:
    """Publishers and subscriptions count alike, each type once, sorted; clients name a service too."""
    other = endpoint(LISTENER, 4, Kind.SUBSCRIPTION, "/chatter", "std_msgs/msg/Int32")
    client = endpoint(TALKER, 5, Kind.CLIENT, "/add", ADD)
    cache = cache_of(CHATTER, HEARD, other, client)

    assert cache.topics() == {"/chatter": ["std_msgs/msg/Int32", STRING]}
    assert cache.services() == {"/add": [ADD]}


def test_endpoints_can_be_asked_for() -> None:
    """By kind, by name, by node; sorted by name, node and type."""
    second = endpoint(TALKER, 9, Kind.PUBLISHER, "/alpha")
    cache = cache_of(CHATTER, second, HEARD, SERVER)

    assert cache.endpoints(Kind.PUBLISHER) == [second, CHATTER]
    assert cache.endpoints(Kind.PUBLISHER, "/chatter") == [CHATTER]
    assert cache.endpoints(Kind.PUBLISHER, node="/robot/listener") == []
    assert cache.endpoints(Kind.SERVICE, node="/robot/listener") == [SERVER]


def test_offered_services() -> None:
    """Those that users have written, and apart from them those of every node and of actions; clients offer none."""
    asked = endpoint(TALKER, 2, Kind.CLIENT, "/reset", ADD)
    inner = endpoint(TALKER, 3, Kind.SERVICE, "/talker/list_parameters", "rcl_interfaces/srv/ListParameters")
    goal = endpoint(LISTENER, 4, Kind.SERVICE, "/turn/_action/send_goal", "turtlesim/action/Turn_SendGoal")

    assert cache_of(*GRAPH, asked, inner, goal).offered() == ({"/add"}, {inner.name, goal.name})


def test_actions_are_told_by_their_feedback() -> None:
    """An action shows its own name and type, not those of the entities it is made of."""
    feedback = endpoint(
        TALKER, 3, Kind.PUBLISHER, "/fibonacci/_action/feedback", "example_interfaces/action/Fibonacci_FeedbackMessage"
    )
    status = endpoint(TALKER, 4, Kind.PUBLISHER, "/fibonacci/_action/status", "action_msgs/msg/GoalStatusArray")
    cache = cache_of(TALKER, CHATTER, feedback, status)

    assert cache.actions() == {"/fibonacci": ["example_interfaces/action/Fibonacci"]}
    assert cache.topics() == {"/chatter": [STRING]}


def test_a_name_of_another_kind() -> None:
    """What it is instead is told, else the nearest of the known names; actions that nobody serves are not served."""
    feedback = "example_interfaces/action/Fibonacci_FeedbackMessage"
    cache = cache_of(
        *GRAPH,
        endpoint(LISTENER, 3, Kind.PUBLISHER, "/go/_action/feedback", feedback),
        endpoint(TALKER, 2, Kind.SUBSCRIPTION, "/goo/_action/feedback", feedback),
    )
    assert cache.served_actions() == ["/go"]
    assert cache.instead("/add", []) == f"; it is a service, of type {ADD}"
    assert cache.instead("/chatter", []) == f"; it is a topic, of type {STRING}"
    assert cache.instead("/go", []) == "; it is an action, of type example_interfaces/action/Fibonacci"
    assert cache.instead("/talker", []) == "; it is a node"
    assert cache.instead("/chater", ["/chatter"]) == "; did you mean '/chatter'?"
    assert (
        cache.instead("/arm", ["/arm/left", "/arms", "/arm/right"]) == "; it is a namespace, with /arm/left, /arm/right"
    )
    assert cache.instead("/arm", [f"/arm/n{i}" for i in range(5)]).endswith("/arm/n0, /arm/n1, /arm/n2 and 2 more")


def test_a_name_without_the_namespace() -> None:
    """Is told to a node that has a slash in front of it; those of ROS itself need none."""
    log = endpoint(LISTENER, 4, Kind.PUBLISHER, "/rosout")
    cache = cache_of(*GRAPH, log, endpoint(LISTENER, 5, Kind.SUBSCRIPTION, "/robot/scan"))
    way = "and needs 'chatter': a slash in front keeps the namespace out"
    assert cache.instead("/robot/chatter", ["/chatter"]) == f"; /robot/listener has /chatter, {way}"
    assert cache.absolute("/robot/add").startswith("; /robot/listener has /add, and needs 'add'")
    assert cache.unpublished("/robot/scan") == "topic [/robot/scan] has subscriptions, and no publisher yet"
    for name in ("/robot/rosout", "/chatter", "/other/chatter", "/robot/listener/chatter"):
        assert cache.absolute(name) == ""


def test_topics_that_nobody_publishes() -> None:
    """One that somebody waits for is called as it should be; else the nearest that is published may be meant."""
    cache = GraphCache()
    for entity in (TALKER, CHATTER, LISTENER, endpoint(LISTENER, 3, Kind.SUBSCRIPTION, "/cmd_vel")):
        cache.apply(entity.token, alive=True)
    assert cache.unpublished("/cmd_vel") == "topic [/cmd_vel] has subscriptions, and no publisher yet"
    assert cache.unpublished("/talker") == "topic [/talker] does not appear to be published yet; it is a node"
    near = "; did you mean '/chatter'?"
    assert cache.unpublished("/chattr") == f"topic [/chattr] does not appear to be published yet{near}"
    assert cache.unpublished("/cmd_val").endswith(
        "yet; did you mean '/cmd_vel'?"
    )  # published only while somebody drives


def test_calls_of_which_nobody_tells() -> None:
    """A service has to have introspection; a name that none has is answered with the nearest, or with what it is."""
    cache = cache_of(*GRAPH)
    text = "/add publishes no events of its calls yet; its node must call configure_intro"
    assert cache.without_events("/add").startswith(text)
    assert cache.without_events("/ad") == "no node offers the service /ad; did you mean '/add'?"
    assert cache.without_events("/chatter") == f"no node offers the service /chatter; it is a topic, of type {STRING}"


SPAWN = "turtlesim/srv/Spawn"
TURTLESIM = [
    endpoint(TALKER, 10 + i, Kind.SERVICE, name, f"turtlesim/srv/{type_}")
    for i, (name, type_) in enumerate([("/spawn", "Spawn"), ("/kill", "Kill"), ("/turtle1/set_pen", "SetPen")])
]


@pytest.mark.parametrize(
    ("name", "type_name", "told"),
    [
        ("/spwan", SPAWN, "; did you mean '/spawn'?"),
        ("/turtle1/spawn", SPAWN, "; did you mean '/spawn'?"),
        ("/new_turtle", SPAWN, "; of that type there is /spawn"),
        ("/turtle1/set_pem", SPAWN, "; of that type there is /spawn"),
        ("/turtle1/set_pem", ADD, "; did you mean '/turtle1/set_pen', of type turtlesim/srv/SetPen?"),
        ("/set_the_position", ADD, ""),
    ],
)
def test_services_in_place_of_one_that_nobody_offers(name: str, type_name: str, told: str) -> None:
    """They are of its type; one of another type only if the name is hardly different."""
    assert cache_of(TALKER, *TURTLESIM).service_of_type(name, type_name) == told


def test_services_of_one_type_are_counted() -> None:
    """Few are listed."""
    many = [endpoint(TALKER, i, Kind.SERVICE, f"/{c}{c}{c}", SPAWN) for i, c in enumerate("abcde")]
    assert cache_of(*many).service_of_type("/x", SPAWN) == "; of that type there is /aaa, /bbb, /ccc and 2 more"


def test_repr_counts() -> None:
    """What is printed says how much there is."""
    assert repr(cache_of(*GRAPH)) == "<GraphCache 2 nodes, 5 tokens>"


@slow
@given(st.lists(st.tuples(st.sampled_from(GRAPH), st.booleans()), max_size=30))
def test_any_history_of_tokens(events: list[tuple[Entity, bool]]) -> None:
    """After any history the picture is that of a plain model, and every change is reported once."""
    cache, model = GraphCache(), dict[str, Entity]()
    told: dict[Entity, bool] = {}
    for entity, alive in events:
        if alive:
            model.setdefault(entity.token, entity)
        elif model.pop(entity.token, None) is not None and entity.kind is Kind.NODE:
            model = {t: e for t, e in model.items() if (e.zid, e.nid) != (entity.zid, entity.nid)}
        for change in cache.apply(entity.token, alive=alive):
            assert told.get(change.entity, False) is not change.alive
            told[change.entity] = change.alive

        assert set(cache) == set(model.values()) == {e for e, there in told.items() if there}
    assert all(parse_token(e.token) == e for e in cache)
    for entity in GRAPH:
        cache.apply(entity.token, alive=False)
    assert not cache._of_node  # nothing is remembered of what has gone


def test_what_is_refused_is_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    """What cannot be read, and what is too much."""
    monkeypatch.setattr(cache_module, "TOKENS_BOUND", 1)
    node = "@ros2_lv/0/abc/{0}/{0}/NN/%/%/n{0}"
    cache = GraphCache([node.format(1), "@ros2_lv/0/abc/9x/9x/NN/%/%/n", node.format(2)])
    assert cache.nodes() == ["/n1"]
    assert cache.refused == 2
