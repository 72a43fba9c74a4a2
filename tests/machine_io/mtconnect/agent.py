#!/usr/bin/python3
"""An MTConnect agent that knows the time and can misbehave. Prints "port N", then obeys lines on its
standard input, and answers each with "ok":

    stream yes|no       answers in parts that go on (as cppagent), or whole (as LinuxCNC's, HTTP/1.0)
    rate HZ             observations a second; 0: the machine stands
    fault WORD          none unavailable down silent hangup garbage doctype endless notfound lies
                        noclock
    clock AGENT STAMPS  the agent's clock is ahead by so many s, that of the stamps by so many more
    late S              observations come so long after they were stamped
    chop N              bytes at a time; 0: as they are
    slot FEED           from X -20 to X 60 at Y 0 Z -2 with so many mm/s, a second after the first
                        question to /sample; it stands before and after
    forget              the next question to /sample is the first
    kinematics MODULE   /probe has LinuxCNC's words for it
    restart             begins anew: another instanceId, sequence numbers from 1
    reset               sequence numbers from 1, and the same instanceId
    overrun             the buffer loses all that it has, and 500 more go by

X is the seconds since this program began (in mm), Y = 2 X + 1, Z = -X: so that a sample tells how old
it is, and whether it is all of one time.
"""
import sys
import threading
import time
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from urllib.parse import parse_qs, urlparse

BEGUN = time.time()
BUFFER = 2000
lock = threading.RLock()
told = threading.Condition(lock)


class Agent:
    streams = True
    rate = 50.0
    fault = "none"
    ahead = 0.0
    stamps_ahead = 0.0
    late = 0.0
    chop = 0
    module = ""
    slot = 0.0
    asked = None        # when /sample was asked for the first time
    instance = 1000
    epoch = 0           # streams of before end
    first = 1
    next = 1
    buffer = []         # (sequence, id, element, stamp, value)
    latest = {}
    ended = False


def stamp(moment):
    micro = round(moment * 1e6)
    return time.strftime("%Y-%m-%dT%H:%M:%S", time.gmtime(micro // 1000000)) + ".%06dZ" % (micro % 1000000)


def observe(values, moment):
    text = stamp(moment + Agent.ahead + Agent.stamps_ahead)
    for name, value in values:
        if name in Agent.latest and Agent.latest[name][4] == value:
            continue
        one = (Agent.next, name, ELEMENTS[name], text, value)
        Agent.next += 1
        Agent.latest[name] = one
        Agent.buffer.append(one)
    if len(Agent.buffer) > BUFFER:
        del Agent.buffer[:-BUFFER]
    Agent.first = Agent.buffer[0][0] if Agent.buffer else Agent.next
    told.notify_all()


ELEMENTS = {"avail": "Availability", "x": "Position", "y": "Position", "z": "Position",
            "exec": "Execution", "line": "LineNumber", "tool": "ToolNumber", "rpm": "RotaryVelocity",
            "load": "Load"}


def place(moment):
    t = moment - BEGUN
    if Agent.slot:
        way = Agent.slot * (moment - Agent.asked - 1) if Agent.asked else 0
        return [("x", "%.6f" % (-20 + min(80, max(0, way)))), ("y", "0"), ("z", "-2")]
    return [("x", "%.6f" % t), ("y", "%.6f" % (2 * t + 1)), ("z", "%.6f" % -t)]


def machine():
    waiting = []
    due = time.time()
    while not Agent.ended:
        with lock:
            rate = Agent.rate
        now = time.time()
        if rate > 0 and now >= due:
            waiting.append((now + Agent.late, now))
            due = max(due + 1 / rate, now - 1 / rate)
        elif rate == 0:
            due = now
        with lock:
            while waiting and waiting[0][0] <= now:
                moment = waiting.pop(0)[1]
                values = place(moment)
                if Agent.fault == "unavailable":
                    values[1] = ("y", "UNAVAILABLE")
                if Agent.fault == "down":
                    values = [(name, "UNAVAILABLE") for name in ELEMENTS]
                else:
                    values = [("avail", "AVAILABLE")] + values + [("exec", "ACTIVE"), ("line", "12"),
                                                                 ("tool", "4"), ("rpm", "1000"),
                                                                 ("load", "35.5")]
                observe(values, moment)
        time.sleep(0.002)


def header(kind):
    noclock = Agent.fault == "noclock"
    created = "soon" if noclock else stamp(time.time() + Agent.ahead)
    return ('<Header creationTime="%s" sender="test" instanceId="%d" version="1.7" bufferSize="%d"%s/>'
            % (created, Agent.instance, BUFFER,
               ' firstSequence="%d" lastSequence="%d" nextSequence="%d"'
               % (Agent.first, max(1, Agent.next - 1), Agent.next) if kind == "Streams" else ""))


def streams(observations):
    body = "".join('<%s dataItemId="%s" timestamp="%s" sequence="%d">%s</%s>' % (e, i, s, n, v, e)
                   for n, i, e, s, v in observations)
    return ('<?xml version="1.0" encoding="UTF-8"?>\n<MTConnectStreams xmlns="urn:mtconnect.org:'
            'MTConnectStreams:1.7">%s<Streams><DeviceStream name="Other" uuid="o"><ComponentStream>'
            '<Samples><Position dataItemId="x" timestamp="2000-01-01T00:00:00Z" sequence="1">99999'
            '</Position></Samples></ComponentStream></DeviceStream><DeviceStream name="Test" uuid="u">'
            '<ComponentStream component="Path" componentId="p"><Samples>%s</Samples></ComponentStream>'
            '</DeviceStream></Streams></MTConnectStreams>' % (header("Streams"), body))


def probe():
    def axis(letter):
        return ('<Linear id="a%s" name="%s"><DataItems><DataItem category="SAMPLE" id="%s" '
                'type="POSITION" subType="ACTUAL" units="MILLIMETER"/></DataItems>%s</Linear>'
                % (letter, letter, letter.lower(), travel.get(letter, "")))
    travel = {"X": "<Configuration><Specifications><Specification type='POSITION' units='MILLIMETER'>"
                   "<Maximum>400</Maximum><Minimum>-25.5</Minimum></Specification></Specifications>"
                   "</Configuration>",
              "Z": "<Configuration><Specifications><Specification type='POSITION' units='MILLIMETER'>"
                   "<Maximum>7</Maximum></Specification></Specifications></Configuration>"}
    own = "<Description><Kinematics module='%s'/></Description>" % Agent.module if Agent.module else ""
    items = "".join('<DataItem category="EVENT" id="%s" type="%s"/>' % pair for pair in
                    (("exec", "EXECUTION"), ("line", "LINE_NUMBER"), ("tool", "TOOL_NUMBER")))
    return ('<MTConnectDevices>%s<Devices><Device id="d" name="Test" uuid="u">%s<DataItems><DataItem '
            'category="EVENT" id="avail" type="AVAILABILITY"/></DataItems><Components><Axes id="ax">'
            '<Components>%s<Rotary id="s" name="S"><DataItems><DataItem category="SAMPLE" id="rpm" '
            'type="ROTARY_VELOCITY" subType="ACTUAL" units="REVOLUTION/MINUTE"/><DataItem '
            'category="SAMPLE" id="load" type="LOAD" units="PERCENT"/></DataItems></Rotary>'
            '</Components></Axes><Path id="p"><DataItems>%s</DataItems></Path></Components></Device>'
            '</Devices></MTConnectDevices>' % (header("Devices"), own, "".join(map(axis, "XYZ")), items))


def error(code, text):
    return ('<MTConnectError>%s<Errors><Error errorCode="%s">%s</Error></Errors></MTConnectError>'
            % (header("Error"), code, text))


class Handler(BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"

    def log_message(self, *_):
        pass

    def put(self, data):
        step = Agent.chop or len(data) or 1
        for at in range(0, len(data), step):
            self.wfile.write(data[at:at + step])
            self.wfile.flush()

    def whole(self, text, status=200):
        data = text.encode()
        self.send_response(status)
        self.send_header("Content-Type", "application/xml")
        self.send_header("Content-Length", str(len(data)))
        if not Agent.streams:
            self.send_header("Connection", "close")
            self.close_connection = True
        self.end_headers()
        self.put(data)

    def refuse(self):
        """True: what is asked is answered wrongly."""
        fault = Agent.fault
        if fault == "silent":
            while Agent.fault == "silent" and not Agent.ended:
                time.sleep(0.02)
            self.close_connection = True
            return True
        if fault == "notfound":
            self.whole("<html>no</html>", 404)
        elif fault == "garbage":
            self.whole("<MTConnectStreams><Header</MTConnectStreams>")
        elif fault == "doctype":
            self.whole('<!DOCTYPE a [<!ENTITY b "bb"><!ENTITY c "&b;&b;&b;">]>'
                       '<MTConnectStreams>&c;</MTConnectStreams>')
        elif fault == "endless":
            self.send_response(200)
            self.send_header("Content-Type", "application/xml")
            self.end_headers()
            try:
                while not Agent.ended:
                    self.wfile.write(b"<a>" * 30000)
            except OSError:
                pass
            self.close_connection = True
        elif fault == "hangup":
            self.close_connection = True
        else:
            return False
        return True

    def do_GET(self):
        asked = urlparse(self.path)
        words = parse_qs(asked.query)
        try:
            if self.refuse():
                return
            if asked.path == "/probe":
                with lock:
                    text = probe()
                self.whole(text)
            elif asked.path == "/current":
                with lock:
                    text = streams(sorted(Agent.latest.values()))
                self.whole(text)
            elif asked.path == "/sample":
                self.sample(int(words["from"][0]), int(words["count"][0]),
                            float(words["interval"][0]) / 1e3, float(words["heartbeat"][0]) / 1e3)
            else:
                self.whole(error("UNSUPPORTED", "no " + asked.path), 404)
        except (BrokenPipeError, ConnectionResetError):
            self.close_connection = True

    def sample(self, start, count, interval, heartbeat):
        with lock:
            Agent.asked = Agent.asked or time.time()
            bad = start < Agent.first or start > Agent.next
            text = error("OUT_OF_RANGE", "from=%d, there is %d to %d" % (start, Agent.first, Agent.next)) \
                if bad else streams([o for o in Agent.buffer if start <= o[0] < start + count])
        if bad or not Agent.streams:
            self.whole(text, 404 if bad else 200)
            return
        self.send_response(200)
        self.send_header("Content-Type", "multipart/x-mixed-replace;boundary=a1b2")
        self.send_header("Connection", "close")
        self.end_headers()
        self.close_connection = True
        epoch = Agent.epoch
        sent = 0.0
        while not Agent.ended and Agent.epoch == epoch:
            with lock:
                some = [o for o in Agent.buffer if o[0] >= start][:count]
                if not some and time.time() - sent < heartbeat:
                    told.wait(0.01)
                    continue
                if start < Agent.first and Agent.first != 1:
                    text = error("OUT_OF_RANGE", "too slow")
                else:
                    text = streams(some)
                start = some[-1][0] + 1 if some else Agent.next
            if Agent.fault == "silent":
                time.sleep(0.02)
                continue
            if Agent.fault == "hangup":
                return
            if Agent.fault == "garbage":
                text = text[:len(text) // 2]
            data = text.encode()
            length = 10 ** 9 if Agent.fault == "lies" else len(data)
            self.put(b"--a1b2\r\nContent-type: text/xml\r\nContent-length: %d\r\n\r\n" % length
                     + data + b"\r\n")
            sent = time.time()
            time.sleep(interval)


def obey(line):
    words = line.split()
    with lock:
        if words[0] == "stream":
            Agent.streams = words[1] == "yes"
        elif words[0] == "rate":
            Agent.rate = float(words[1])
        elif words[0] == "fault":
            Agent.fault = words[1]
        elif words[0] == "clock":
            Agent.ahead, Agent.stamps_ahead = float(words[1]), float(words[2])
        elif words[0] == "late":
            Agent.late = float(words[1])
        elif words[0] == "slot":
            Agent.slot = float(words[1])
        elif words[0] == "forget":
            Agent.asked = None
            observe(place(time.time()), time.time())
        elif words[0] == "kinematics":
            Agent.module = words[1]
        elif words[0] == "chop":
            Agent.chop = int(words[1])
        elif words[0] in ("restart", "reset"):
            if words[0] == "restart":
                Agent.instance += 1
            Agent.epoch += 1
            Agent.buffer, Agent.latest, Agent.next, Agent.first = [], {}, 1, 1
        elif words[0] == "overrun":
            Agent.next += 500
            Agent.buffer, Agent.first = [], Agent.next


with lock:
    observe([("avail", "AVAILABLE")] + place(time.time()) +
            [("exec", "ACTIVE"), ("line", "12"), ("tool", "4"), ("rpm", "1000"), ("load", "35.5")],
            time.time())
server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
server.daemon_threads = True
threading.Thread(target=server.serve_forever, daemon=True).start()
threading.Thread(target=machine, daemon=True).start()
print("port %d %.6f" % (server.server_address[1], BEGUN), flush=True)
for command in sys.stdin:
    obey(command)
    print("ok", flush=True)
Agent.ended = True
