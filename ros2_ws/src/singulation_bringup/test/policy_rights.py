"""SROS2 policies as rights on DDS topics: what ``ros2 security`` makes of them, in plain Python.

The mapping is ROS 2's own: topics begin with ``rt``, the two topics of a service with ``rq`` and ``rr``, and an action
is three services and two topics below ``_action``. What sros2 adds for discovery is not part of a policy.
"""

from pathlib import Path
from xml.etree import ElementTree

INCLUDE = "{http://www.w3.org/2001/XInclude}include"
_ACTION_SERVICES = ("send_goal", "cancel_goal", "get_result")
_ACTION_TOPICS = ("feedback", "status")


def rights(policy):
    """{(enclave, ALLOW or DENY, publish or subscribe, DDS topic)} of a policy file."""
    found = set()
    for enclave in ElementTree.parse(policy).getroot().iter("enclave"):
        name = enclave.get("path").rpartition("/")[2]
        for profile in enclave.iter("profile"):
            for rule in _rules(profile, Path(policy).parent):
                found |= {(name, *right) for right in _of_rule(rule, profile)}
    return found


def allowed(found, enclave, direction, topic):
    """Whether a right covers a topic; what is denied comes first, and a pattern may end in or hold one ``*``."""

    def covers(verdict):
        return any(
            _matches(pattern, topic)
            for name, said, way, pattern in found
            if (name, said, way) == (enclave, verdict, direction)
        )

    return not covers("DENY") and covers("ALLOW")


def _matches(pattern, topic):
    head, star, tail = pattern.partition("*")
    return topic == pattern if not star else topic.startswith(head) and topic.endswith(tail)


def _rules(profile, folder):
    for element in profile:
        if element.tag == INCLUDE:
            assert element.get("xpointer") == "xpointer(/profile/*)"
            yield from ElementTree.parse(folder / element.get("href")).getroot()
        else:
            yield element


def _of_rule(rule, profile):
    verbs = [(verb, verdict) for verb, verdict in rule.attrib.items()]
    for item in rule:
        name = _full_name(item.text, profile)
        for verb, verdict in verbs:
            for direction, topic in _topics(rule.tag, verb, name):
                yield verdict, direction, topic


def _full_name(name, profile):
    if name.startswith("/"):
        return name
    if name.startswith("~"):
        return f"{profile.get('ns')}{profile.get('node')}{name[1:]}"
    return f"{profile.get('ns')}{name}"


def _topics(kind, verb, name):
    if kind == "topics":
        return [(verb, f"rt{name}")]
    if kind == "services":
        return _service(verb == "request", name)
    asks = verb == "call"
    found = [pair for service in _ACTION_SERVICES for pair in _service(asks, f"{name}/_action/{service}")]
    way = "subscribe" if asks else "publish"
    return found + [(way, f"rt{name}/_action/{topic}") for topic in _ACTION_TOPICS]


def _service(asks, name):
    request, reply = f"rq{name}Request", f"rr{name}Reply"
    return [("publish" if asks else "subscribe", request), ("subscribe" if asks else "publish", reply)]
