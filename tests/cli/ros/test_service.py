"""`graphflow service list` and `service call`."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.cases import slow
from tests.conftest import Machine

pytestmark = pytest.mark.real

ADD, TYPE = "/office/clerk/add", "example_interfaces/srv/AddTwoInts"


def test_list(standing: Machine) -> None:
    """`list` prints names, sorted; with types; their number; with hidden ones; as JSON."""
    names = standing.look("service", "list").split()
    assert names == sorted(names)
    assert ADD in names
    assert f"{ADD} [{TYPE}]\n" in standing.look("service", "list", "-t")
    assert standing.look("service", "list", "-c") == f"{len(names)}\n"
    assert json.loads(standing.look("service", "list", "--json"))[ADD] == [TYPE]
    assert "/office/clerk/_add" not in names
    assert "/office/clerk/_add" in standing.look("service", "list", "--include-hidden-services").split()


def test_type_find_and_info(standing: Machine) -> None:
    """The one from the other; how many nodes offer and call it, and which."""
    assert standing.look("service", "type", ADD) == f"{TYPE}\n"
    assert "no node offers the service /ad" in standing.look("service", "type", "/ad", code=1)
    assert ADD in standing.look("service", "find", TYPE).split()
    assert standing.look("service", "find", "std_srvs/srv/Empty", "-c").endswith("0\n")
    assert standing.look("service", "info", ADD) == f"Type: {TYPE}\nClients count: 0\nServices count: 1\n"
    assert "Services count: 1\n    /office/clerk\n" in standing.look("service", "info", "-v", ADD)


def test_call(standing: Machine) -> None:
    """Request and response are shown, as ROS 2 shows them; with --json only the response."""
    request, response = (f"example_interfaces.srv.AddTwoInts_{word}" for word in ("Request", "Response"))
    assert standing.look("service", "call", ADD, TYPE, "{a: 1, b: 2}") == (
        f"requester: making request: {request}(a=1, b=2)\n\nresponse:\n{response}(sum=3)\n\n"
    )
    assert json.loads(standing.look("service", "call", "office/clerk/add", TYPE, "{a: 1, b: 2}", "--json")) == {
        "sum": 3
    }


@pytest.mark.parametrize(
    ("words", "code", "told"),
    [
        ([ADD], 2, f"error: TYPE is missing; {ADD} is of type {TYPE}: graphflow service call {ADD} {TYPE}"),
        (["/office/clerk/ad"], 1, f"no node offers the service /office/clerk/ad; did you mean '{ADD}'?"),
        ([ADD, "std_srvs/srv/Trigger"], 2, f"error: {ADD} is of type {TYPE}, not std_srvs/srv/Trigger"),
        (
            [ADD, "{a: 1}"],
            2,
            f"error: '{{a: 1}}' was read as the type of {ADD}; its type is {TYPE}: graphflow service call {ADD} {TYPE} "
            "'{a: 1}'",
        ),
        ([ADD, "1", "2"], 2, f"its type is {TYPE}: graphflow service call {ADD} {TYPE} '{{a: 1, b: 2}}'"),
        ([ADD, "1"], 2, f"its type is {TYPE}: graphflow service call {ADD} {TYPE} ..."),
        ([ADD, TYPE, "{a: -1}"], 1, f"the handler of {ADD} raised ValueError: no debts"),
        ([ADD, TYPE, "{a: x}"], 2, "AddTwoInts_Request.a: expected int64, got 'x'"),
        ([ADD, TYPE, "{c: 1}"], 2, "c"),
        ([ADD, TYPE, "{a: 1"], 2, "not valid YAML"),
        ([ADD, TYPE, "--timeout", "0"], 2, "Invalid value for '--timeout'"),
    ],
)
def test_a_call_that_fails(standing: Machine, words: list[str], code: int, told: str) -> None:
    """The exit code depends on whose fault it was; the error has the right command."""
    assert told in standing.look("service", "call", *words, code=code)


def test_a_service_is_waited_for(standing: Machine) -> None:
    """A missing service is waited for, which is reported, until the timeout."""
    text = standing.look("service", "call", "/office/clerk/ad", TYPE, "{}", "--timeout", "0.01", code=4)
    assert text.startswith("waiting for service to become available...\nerror: no node offers the service")


@slow
def test_a_call_that_is_repeated(standing: Machine) -> None:
    """`--rate` calls repeatedly until Ctrl-C, which is not a failure."""
    calls = standing.start("service", "call", ADD, TYPE, "{a: 4, b: 5}", "--rate", "50")
    calls.wait_for("sum=9")
    calls.text = ""
    calls.wait_for("sum=9")
    assert calls.end() == 0


ZOO = """\
from graphflow import Abort, Node, action, service
from graphflow.msgs.example_interfaces.action import Fibonacci
from graphflow.msgs.std_srvs.srv import SetBool
from tests.cases import slow


class Zoo(Node):
    async def on_start(self):
        self.log.info("the zoo is open")

    @service(SetBool, "open")
    async def open(self, request):
        if not request.data:
            self.log.error("it is closed already")
            return SetBool.Response()
        return SetBool.Response(success=True)

    @action(Fibonacci, "feed")
    async def feed(self, goal):
        if goal.request.order > 1:
            self.log.warning("that is too much")
        if goal.request.order > 2:
            raise Abort() if goal.request.order > 3 else Abort("no food")
        return Fibonacci.Result()
"""


@slow
def test_what_the_server_logs(machine: Machine, tmp_path: Path) -> None:
    """A response without a reason, and a goal's end, come with the problems that the server has logged meanwhile."""
    (tmp_path / "zoo.py").write_text(ZOO)
    zoo = machine.start("run", "zoo:Zoo", cwd=tmp_path)
    zoo.wait_for("open")
    call = ("service", "call", "/open", "std_srvs/srv/SetBool")
    assert "meanwhile /zoo logged an error: it is closed already" in machine.look(*call, "data: false")
    assert "meanwhile" not in machine.look(*call, "data: true")
    goal = ("action", "send_goal", "/feed", "example_interfaces/action/Fibonacci")
    assert "meanwhile" not in machine.look(*goal, "order: 1")
    assert machine.look(*goal, "order: 2").count("meanwhile /zoo logged a warning: that is too much") == 1
    text = machine.look(*goal, "order: 3", code=1)
    assert "/feed aborted the goal: no food" in text
    assert text.count("meanwhile") == 1
    assert "/feed aborted the goal\nmeanwhile /zoo logged a warning: that is too" in machine.look(
        *goal, "order: 4", code=1
    )
    assert zoo.end() == 0
