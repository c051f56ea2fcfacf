"""A recorder that comes late, and one that is slow, still gets every entry of the record."""

import threading

from rclpy.node import Node
from std_msgs.msg import String

from singulation_node.qos import RECORD
from singulation_node.testing import Mailbox, spinning, wait_until

COUNT = RECORD.depth


def publish(publisher, numbers):
    for number in numbers:
        publisher.publish(String(data=str(number)))


def test_who_comes_late_gets_the_record(ros_context):
    writer, reader = Node("writer", context=ros_context), Node("reader", context=ros_context)
    with spinning(writer, reader):
        publish(writer.create_publisher(String, "record", RECORD), range(COUNT))
        mailbox = Mailbox(reader, String, "record", RECORD)
        mailbox.wait(COUNT)
        assert [int(message.data) for message in mailbox.messages] == list(range(COUNT))


def test_who_is_busy_misses_nothing(ros_context):
    writer, reader = Node("writer", context=ros_context), Node("reader", context=ros_context)
    received, free = [], threading.Event()

    def take(message):
        assert free.wait(timeout=20.0)
        received.append(int(message.data))

    publisher = writer.create_publisher(String, "record", RECORD)
    reader.create_subscription(String, "record", take, RECORD)
    with spinning(writer, reader):
        wait_until(lambda: publisher.get_subscription_count() == 1, what="the reader")
        publish(publisher, range(COUNT))
        free.set()
        wait_until(lambda: len(received) == COUNT, what="all entries")
    assert received == list(range(COUNT))
