// The press of press.py behind a server of node-opcua: node press_node.js FOLDER PKI; FOLDER is where its packages are.
// Orders and stops are methods, what it shows are variables. It prints and is told what press.py is.
"use strict";

const [folder, pki] = process.argv.slice(2);
const { OPCUACertificateManager } = require(`${folder}/node-opcua-certificate-manager`);
const { OPCUAServer } = require(`${folder}/node-opcua-server`);
const { StatusCodes } = require(`${folder}/node-opcua-status-code`);
const { DataType, Variant } = require(`${folder}/node-opcua-variant`);

const NUMBERS = ["boot", "accepted", "done", "rejected", "reason", "failed", "failure", "strokes"];
const shown = Object.fromEntries(NUMBERS.map((name) => [name, 0]));
Object.assign(shown, { reason: 1, state: "stopped", guard: "open", seen: "good" });
let takes = 0.1;
let refuses = false;
let work = null;

const say = (word, number) => console.log(word, number, Number(process.hrtime.bigint()) / 1e9);

function boot() {
    if (work !== null) clearTimeout(work.timer);
    work = null;
    Object.assign(shown, { boot: shown.boot + 1, accepted: 0, done: 0, rejected: 0, state: "stopped" });
    say("boot", 0);
}

function begin(number, end) {
    if (refuses || work !== null || shown.state === "latched") {
        refuses = false;
        shown.rejected = number;
        return;
    }
    say("begin", number);
    Object.assign(shown, { accepted: number, state: "moving" });
    const timer = setTimeout(() => {
        end();
        say("end", number);
        work = null;
        Object.assign(shown, { state: "stopped", done: number });
    }, 1000 * takes);
    work = { number, timer };
}

function halt(state) {
    if (work !== null) {
        clearTimeout(work.timer);
        say("drop", work.number);
    }
    work = null;
    shown.state = state;
}

const METHODS = {
    Open: [["number"], ({ number }) => begin(number, () => (shown.guard = "open"))],
    Close: [["number"], ({ number }) => begin(number, () => (shown.guard = "closed"))],
    Press: [["strokes", "number"], ({ strokes, number }) => begin(number, () => (shown.strokes = strokes))],
    Measure: [["number"], ({ number }) => begin(number, () => (shown.seen = "good"))],
    Halt: [[], () => halt(shown.state === "latched" ? "latched" : "stopped")],
    Latch: [[], () => halt("latched")],
    Clear: [[], () => (shown.state = "stopped")],
};

async function main() {
    const manager = new OPCUACertificateManager({ rootFolder: pki, automaticallyAcceptUnknownCertificate: true });
    await manager.initialize();
    const server = new OPCUAServer({ port: 0, hostname: "127.0.0.1", serverCertificateManager: manager });
    await server.initialize();
    const space = server.engine.addressSpace;
    const own = space.registerNamespace("urn:press");
    const device = own.addObject({ browseName: "Device", nodeId: "s=Device", organizedBy: space.rootFolder.objects });
    for (const name of Object.keys(shown)) {
        const dataType = NUMBERS.includes(name) ? DataType.UInt16 : DataType.String;
        const get = () => new Variant({ dataType, value: shown[name] });
        const value = { get };
        own.addVariable({
            componentOf: device,
            browseName: name,
            nodeId: `s=${name}`,
            dataType,
            minimumSamplingInterval: 10,
            value,
        });
    }
    for (const [name, [given, act]] of Object.entries(METHODS)) {
        const inputArguments = given.map((each) => ({ name: each, dataType: DataType.UInt16 }));
        const method = own.addMethod(device, { browseName: name, nodeId: `s=${name}`, inputArguments });
        method.bindMethod((values, _context, answered) => {
            act(Object.fromEntries(given.map((each, at) => [each, values[at].value])));
            answered(null, { statusCode: StatusCodes.Good, outputArguments: [] });
        });
    }
    boot();
    await server.start();
    console.log("ready", server.endpoints[0].port);
    for await (const line of require("readline").createInterface({ input: process.stdin })) {
        const [word, value] = line.split(" ");
        if (word === "takes") takes = Number(value);
        if (word === "refuses") refuses = true;
        if (word === "boots") boot();
    }
    process.exit(0);
}

main().catch((error) => {
    console.error(error);
    process.exit(1);
});
