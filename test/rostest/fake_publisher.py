"""A publisher that speaks TCPROS by itself, and says what no library would."""

import socket
import struct
import threading
from typing import List
from xmlrpc.client import ServerProxy
from xmlrpc.server import SimpleXMLRPCServer

import rosgraph
from std_msgs.msg import String

NAME = '/fake'


def header(**fields: str) -> bytes:
    """A connection header with its length."""
    parts = b''.join(struct.pack('<I', len(key) + 1 + len(value)) + key.encode() + b'='
                     + value.encode() for key, value in fields.items())
    return struct.pack('<I', len(parts)) + parts


def string_header(topic: str, node: str) -> bytes:
    """That of a publisher of std_msgs/String."""
    return header(callerid=node, topic=topic, type=String._type, md5sum=String._md5sum,
                  message_definition=String._full_text, latching='0')


class FakePublisher:
    """Is registered at the master, and sends some bytes to each who connects.

    Args:
        says: what it sends, once the subscriber has sent its header
        answers: whether its XML-RPC server answers at all
    """

    def __init__(self, topic: str, says: bytes, node: str = NAME, answers: bool = True) -> None:
        self._topic = topic
        self._node = node
        self._says = says
        self._connections: List[socket.socket] = []
        self._data = socket.create_server(('127.0.0.1', 0))
        self._slave = SimpleXMLRPCServer(('127.0.0.1', 0), logRequests=False)
        self._slave.register_function(self._request_topic, 'requestTopic')
        self._answers = answers
        self.uri = 'http://127.0.0.1:{}/'.format(self._slave.server_address[1])

    def _request_topic(self, *_) -> list:
        return [1, '', ['TCPROS', '127.0.0.1', self._data.getsockname()[1]]]

    def _serve(self) -> None:
        while True:
            try:
                connection, _ = self._data.accept()
            except OSError:
                return  # the socket is closed
            self._connections.append(connection)
            threading.Thread(target=self._say, args=(connection,), daemon=True).start()

    def _say(self, connection: socket.socket) -> None:
        try:
            connection.recv(65536)
            connection.sendall(self._says)
        except OSError:
            pass  # the other side has had enough

    def __enter__(self) -> 'FakePublisher':
        threading.Thread(target=self._serve, daemon=True).start()
        if self._answers:
            threading.Thread(target=self._slave.serve_forever, args=(0.1,),
                             daemon=True).start()
        self._call('registerPublisher', String._type)
        return self

    def __exit__(self, *_) -> None:
        self._call('unregisterPublisher')
        if self._answers:
            self._slave.shutdown()
        self._slave.server_close()
        self._data.shutdown(socket.SHUT_RDWR)
        self._data.close()
        for connection in self._connections:
            connection.close()

    def _call(self, method: str, *arguments: str) -> None:
        master = ServerProxy(rosgraph.get_master_uri())
        getattr(master, method)(self._node, self._topic, *arguments, self.uri)


class FakeTalker(FakePublisher):
    """Publishes empty strings at 2 Hz. A test has many of them in its own process."""

    def __init__(self, topic: str, node: str) -> None:
        self._ended = threading.Event()
        super().__init__(topic, string_header(topic, node), node)

    def _say(self, connection: socket.socket) -> None:
        super()._say(connection)
        try:
            while not self._ended.wait(0.5):
                connection.sendall(struct.pack('<II', 4, 0))
        except OSError:
            pass  # the other side is gone

    def __exit__(self, *error) -> None:
        self._ended.set()
        super().__exit__(*error)
