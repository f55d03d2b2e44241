"""The arguments of `bigactors status`."""

from bigactors.arguments.parser import Command
from bigactors.arguments.say import add_socket

COMMAND = Command(
    "status",
    "say how a running mission stands: vehicles, requests, what may be said",
    "Ask a running mission how it stands, and print it on one screen: where each vehicle is, on its way to what, its\n"
    "mode and battery, who has taken it over; the requests that are not done; what someone may say now.",
    ("bigactors status", "watch bigactors status"),
    add_socket,
)
