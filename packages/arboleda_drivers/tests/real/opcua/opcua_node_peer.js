// A server of node-opcua whose belt is told by variables: node opcua_node_peer.js FOLDER OPTIONS; FOLDER is where its
// packages are, OPTIONS are JSON: the files of a certificate and its key, where to keep others, and `limit`, the
// values that one request may have.
//
// A number in Request gives an order: Verb 1 loads, 2 moves the part to To at Speed, 3 sets the gate to To, 9 is
// refused by an error. Busy is true meanwhile; Error is set before Done, and 0 where all went well. A line on its
// input sets Hold (whether orders wait).
"use strict";

const [folder, json] = process.argv.slice(2);
const options = JSON.parse(json);
const { OPCUACertificateManager } = require(`${folder}/node-opcua-certificate-manager`);
const { OPCUAServer } = require(`${folder}/node-opcua-server`);
const { StatusCodes } = require(`${folder}/node-opcua-status-code`);
const { DataType, Variant, VariantArrayType } = require(`${folder}/node-opcua-variant`);

const WORK_MS = 20;
const TYPES = {
    Request: DataType.Int32,
    Verb: DataType.Byte,
    To: DataType.Int16,
    Speed: DataType.Float,
    Beat: DataType.Int32,
    Halt: DataType.Boolean,
    Busy: DataType.Boolean,
    Done: DataType.Int32,
    Error: DataType.Int16,
    PartAt: DataType.UInt32,
    Gate: DataType.SByte,
    MmS: DataType.Int64,
};
const WRITTEN = ["Request", "Verb", "To", "Speed", "Beat", "Halt"];
const shown = Object.fromEntries(Object.keys(TYPES).map((name) => [name, 0]));
shown.Busy = shown.Halt = false;
let holds = false;

function finish() {
    if (holds && shown.Verb !== 0) return setTimeout(finish, WORK_MS);
    if (shown.Halt) {
        shown.Halt = shown.Busy = false;
        return undefined;
    }
    if (shown.Verb === 1) shown.PartAt = 1;
    if (shown.Verb === 2) [shown.PartAt, shown.MmS] = [shown.To, Math.round(shown.Speed)];
    if (shown.Verb === 3) shown.Gate = shown.To;
    shown.Error = shown.Verb === 9 ? 7 : 0;
    shown.Done = shown.Request;
    shown.Busy = false;
    return undefined;
}

function take(name, value) {
    const changes = shown[name] !== value;
    shown[name] = value;
    if (name !== "Request" || !changes || shown.Busy) return;
    shown.Busy = true;
    setTimeout(finish, WORK_MS);
}

function value(name) {
    const raw = TYPES[name] === DataType.Int64 ? [0, shown[name]] : shown[name];
    return new Variant({ dataType: TYPES[name], arrayType: VariantArrayType.Scalar, value: raw });
}

async function main() {
    const manager = new OPCUACertificateManager({
        rootFolder: options.folder,
        automaticallyAcceptUnknownCertificate: true,
    });
    await manager.initialize();
    const server = new OPCUAServer({
        port: 0,
        hostname: "127.0.0.1",
        serverCertificateManager: manager,
        userCertificateManager: manager,
        certificateFile: options.certificate,
        privateKeyFile: options.key,
        serverInfo: { applicationUri: "urn:server" },
        allowAnonymous: !options.login,
        userManager: { isValidUser: (user, password) => user === "cell" && password === "secret" },
        serverCapabilities: {
            operationLimits: {
                maxNodesPerRead: options.limit,
                maxNodesPerWrite: options.limit,
                maxMonitoredItemsPerCall: options.limit,
            },
        },
    });
    await server.initialize();
    const space = server.engine.addressSpace;
    for (let at = 0; at < options.namespaces; at += 1) space.registerNamespace(`urn:other:${at}`);
    const belt = space.registerNamespace("urn:peer:belt");
    const device = belt.addObject({ browseName: "Device", nodeId: "s=Device", organizedBy: space.rootFolder.objects });
    for (const name of Object.keys(TYPES)) {
        const get = () => value(name);
        const set = (given) => {
            take(name, given.value);
            return StatusCodes.Good;
        };
        belt.addVariable({
            componentOf: device,
            browseName: name,
            nodeId: `s=${name}`,
            dataType: TYPES[name],
            minimumSamplingInterval: 20,
            accessLevel: WRITTEN.includes(name) ? "CurrentRead | CurrentWrite" : "CurrentRead",
            value: WRITTEN.includes(name) ? { get, set } : { get },
        });
    }
    await server.start();
    console.log("ready", server.endpoints[0].port);
    for await (const line of require("readline").createInterface({ input: process.stdin })) holds = line === "hold";
    await server.shutdown();
}

main().catch((error) => {
    console.error(error);
    process.exit(1);
});
