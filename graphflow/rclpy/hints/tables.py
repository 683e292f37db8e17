"""Sentences for common mistakes in rclpy programs: by attribute, by error text and by call."""

from __future__ import annotations

ATTRIBUTES = {
    "method.debug method.info method.warn method.warning method.error method.fatal function.info": (
        "get_logger is a method: write get_logger().info(...)"
    ),
    "Timer.stop Timer.shutdown": "a timer is stopped by timer.cancel(), and started again by timer.reset()",
    "Timer.start": "a timer runs from create_timer on; after timer.cancel(), timer.reset() starts it again",
    "Time.seconds Time.secs Time.sec Time.to_sec Duration.seconds Duration.secs Duration.sec Duration.to_sec": (
        "write .nanoseconds / 1e9"
    ),
    "Time.nanosec Time.nsecs Duration.nanosec Duration.nsecs": "write .nanoseconds",
    "Rate.period Timer.period": "the period of a timer is timer.timer_period_ns, in nanoseconds",
    "T.create_action_server": 'write ActionServer(self, Type, "name", self.execute), from rclpy.action',
    "T.create_action_client": 'write ActionClient(self, Type, "name"), from rclpy.action',
    "T.logger T.log T.loginfo": "write get_logger().info(...)",
    "T.publish": "a publisher publishes: self.publisher = self.create_publisher(...), then self.publisher.publish(...)",
    "T.get_param T.param": 'write get_parameter("name").value',
    "T.now": "write get_clock().now()",
    "T.advertise": "write create_publisher(Type, topic, 10)",
    "T.create_subscriber T.subscribe": "write create_subscription(Type, topic, callback, 10)",
    "RcutilsLogger.info_once RcutilsLogger.warn_once RcutilsLogger.warning_once RcutilsLogger.error_once": (
        "once is an argument: get_logger().info(..., once=True)"
    ),
    "RcutilsLogger.info_throttle RcutilsLogger.warn_throttle RcutilsLogger.warning_throttle": (
        "the seconds between two are an argument: get_logger().info(..., throttle_duration_sec=1.0)"
    ),
    "Client.wait_for_server": "for a service, use wait_for_service()",
    "Client.send_goal Client.send_goal_async": "for a service, use call_async(request)",
    "ActionClient.call ActionClient.call_async": "for an action, use send_goal_async(goal)",
    "ActionClient.wait_for_service": "for an action, use wait_for_server()",
}
"""By class (`T` for nodes) and missing attribute."""

TEXTS: dict[str, str] = {
    r'can only concatenate str \(not "(?:int|float|bool)"\)': "format it: f'... {{value}}', or str(value)",
    r"for \^=?: '(?:float' and '(?:float|int)|int' and 'float)'": "a power is written with **",
    r"no running event loop": (
        "callbacks of rclpy run without asyncio: make a timer for a pause, and await futures of rclpy alone"
    ),
    r"rcl_shutdown already called": "rclpy was already shut down, as Ctrl-C does: end with rclpy.try_shutdown()",
    r"context is invalid|[Cc]ontext must be initialized": (
        "rclpy was shut down before this line, by Ctrl-C or by rclpy.shutdown(): do this earlier, and end with "
        "rclpy.try_shutdown()"
    ),
    r"cannot use Destroyable": (
        "it was already destroyed, by itself or with its node: use it earlier, and call destroy_node() last"
    ),
    r"Context\.init\(\) must only be called once": "call rclpy.init() once, before the first node is created",
    r"(\w+)_(Goal|Result|Feedback|Request|Response)\.__init__\(\) takes 1 positional argument": (
        "fields are given by name, as in {}.{}(name=...)"
    ),
    r"generator already executing": (
        "rclpy.spin has one executor for all threads: add the nodes to one, executor = MultiThreadedExecutor(), "
        "executor.add_node(node) for each, and executor.spin()"
    ),
    r"property 'value' of 'Parameter' object has no setter": (
        "a Parameter is a copy; the node's own is set by set_parameters([Parameter('name', value=...)])"
    ),
    r"invalid transition from state \w+ with event": "the goal has ended already: return its result right after that",
    r"Unrecognized image encoding \[(?:bgr|rgb|mono|bgra|rgba|gray|grey)\]": (
        "the bits of a channel belong to it, as in bgr8 or mono8"
    ),
    r"property '(\w+)' of '\w+' object has no setter|(handle) cannot be modified": (
        "every node has '{0}' already: choose another name for the attribute"
    ),
    r"(?:operand type\(s\) for -:|not supported between instances of) 'Time' and 'Time'": (
        "one of them is a message: rclpy.time.Time.from_msg(stamp) converts it"
    ),
    r"operand.*'(?:Time|Duration)'|not supported between.*'(?:Time|Duration)'": (
        "use the seconds of a time or duration: .nanoseconds / 1e9"
    ),
    r"(?:operand|not supported between).*'Parameter'|^(?!parameter_list).*, got Parameter: write": (
        "a parameter's value is in .value"
    ),
    r"Type 'Type\.DOUBLE' and value '(-?\d+)' do not agree": "a DOUBLE is a float: write {0}.0",
    r"Type 'Type\.INTEGER' and value '(-?\d+)\.\d*' do not agree": "an INTEGER is an int: write {0}",
    r"given value is not one of the allowed types '<class '(\w+)'>'": (
        "give a value, or a type as in declare_parameter('name', Parameter.Type.DOUBLE)"
    ),
    r"given value is not one of the allowed types '\{": (
        "declare a parameter for each key: declare_parameters('gains', [('p', 1.0), ('i', 0.1)])"
    ),
    r"given value is not one of the allowed types": (
        "a parameter is a bool, an int, a float, a str, bytes, or a list of one of them"
    ),
    r"not a list of one of the allowed types": (
        "all elements must be of one type, as in [1.0, 2.5], and none a list: make nested lists parameters of their own"
    ),
    r"in parameters list: ([\w.]+); expecting length": (
        "('{0}') is a string, not a tuple: write ('{0}', 1.0), with its default"
    ),
    r"Third element (.*) at index .* is not a ParameterDescriptor": (
        "the third argument is a ParameterDescriptor(description={0!r}), from rcl_interfaces.msg"
    ),
    r"unknown ROS arguments: [^;]*'[^' ]+ [^']*'[^;]*\]$": (
        "each word is an argument of its own, as in ['-p', 'speed:=1.0']"
    ),
    r"not supported between instances of .*'array\.array'": (
        "that is a whole array: compare an element, as in ranges[0], or min(ranges)"
    ),
    r"parameter must be instance of type": "write set_parameters([Parameter('name', value=6)])",
    r"History and/or depth settings are required|KEEP_LAST without a depth": (
        "give it a depth: QoSProfile(depth=10, ...)"
    ),
    r"descriptor '__init__' (?:requires a 'super' object|of 'super' object needs)": (
        "super is called: write super().__init__('node_name')"
    ),
    r"object\.__init__\(\) takes exactly one argument": "the class has no base class: write class Name(Node):",
    r"rclpy\.\w+\(\) argument after \* must be an iterable": (
        "pass a thread's arguments as a tuple: Thread(target=rclpy.spin, args=(node,))"
    ),
    r"type must be an instance of '<enum 'Type'>'": "pass the value by keyword: Parameter('name', value=2.0)",
    r"parameter \"throttle\w*\" is not one of the recognized logging options": (
        "seconds between two lines are throttle_duration_sec=1.0"
    ),
    r"Must pass a builtin_interfaces\.msg\.Time object": "pass a message's stamp: Time.from_msg(msg.header.stamp)",
    r"of type '(\w+)_ARRAY', expecting type 'BYTE_ARRAY'": (
        "[] counts as a list of bytes: declare Parameter.Type.{0}_ARRAY in place of it"
    ),
    r"could not convert string to float: ''": (
        "an empty text is not a number; read a parameter's .value, since .string_value is empty unless it is a string"
    ),
}
"""By a pattern of the error's text; a sentence may refer to its groups."""

CALLS = {
    "Node.__init__": (
        "write super().__init__('node_name', namespace='...') in the __init__ of your class: without self, and all but "
        "the name by keyword"
    ),
    "QoSProfile.__init__": "pass policies by keyword: QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)",
    "Client.call_async": (
        "it takes one request, as in call_async(AddTwoInts.Request(a=1, b=2)); a callback goes to the future that it "
        "returns: .add_done_callback(self.done)"
    ),
    "RcutilsLogger": "pass one text: get_logger().info(f'... {value}')",
    "Executor.spin": "add the nodes first: executor.add_node(node), and then executor.spin()",
    "Executor.__init__": "add nodes to it: executor.add_node(node)",
    "Executor.add_node": "add each node separately: executor.add_node(node)",
    "init": "write rclpy.init(), or rclpy.init(args=sys.argv)",
    "ParameterMethods.declare_parameters": "write declare_parameters('', [('a', 1), ('b', 2)])",
}
"""The usage of functions, by name or class, where the signature alone does not explain it."""

GIVEN = {
    "ActionClient._graphflow_heard_feedback": "feedback_message",
    "Service._do": "request, response",
    "Service._do_async": "request, response",
    "Subscription._do": "message",
    "Subscription._do_async": "message",
    "_type_of": "message",
    "await_or_execute": "goal_handle",
    "NodeParameters._set": "parameters",
    "NodeParameters._verdict": "parameters",
    "NodeParameters.set_all": "parameters",
}
"""Arguments that graphflow passes to callbacks."""
