// A server of node-opcua for press.py: node press_node.js FOLDER PKI; FOLDER is where its packages are.
// Its input has the methods first, then again and again what it shows; it prints `ready PORT`, then each call of a method.
"use strict";

const [folder, pki] = process.argv.slice(2);
const { OPCUACertificateManager } = require(`${folder}/node-opcua-certificate-manager`);
const { OPCUAServer } = require(`${folder}/node-opcua-server`);
const { StatusCodes } = require(`${folder}/node-opcua-status-code`);
const { DataType, Variant } = require(`${folder}/node-opcua-variant`);

const typeOf = (value) => (typeof value === "number" ? DataType.UInt16 : DataType.String);
const called = []; // the calls that have no answer yet
let shown = {};

function fill(own, device, methods) {
    for (const browseName of Object.keys(shown)) {
        const dataType = typeOf(shown[browseName]);
        const value = { get: () => new Variant({ dataType, value: shown[browseName] }) };
        const place = { componentOf: device, browseName, nodeId: `s=${browseName}` };
        own.addVariable({ ...place, dataType, minimumSamplingInterval: 10, value });
    }
    for (const [browseName, given] of Object.entries(methods)) {
        const inputArguments = given.map((name) => ({ name, dataType: DataType.UInt16 }));
        const method = own.addMethod(device, { browseName, nodeId: `s=${browseName}`, inputArguments });
        method.bindMethod((values, _context, answered) => {
            called.push(() => answered(null, { statusCode: StatusCodes.Good, outputArguments: [] }));
            console.log("call", browseName, ...values.map((each) => each.value));
        });
    }
}

async function main() {
    const manager = new OPCUACertificateManager({ rootFolder: pki, automaticallyAcceptUnknownCertificate: true });
    await manager.initialize();
    const server = new OPCUAServer({ port: 0, hostname: "127.0.0.1", serverCertificateManager: manager });
    await server.initialize();
    const space = server.engine.addressSpace;
    const own = space.registerNamespace("urn:press");
    const device = own.addObject({ browseName: "Device", nodeId: "s=Device", organizedBy: space.rootFolder.objects });
    for await (const line of require("readline").createInterface({ input: process.stdin })) {
        const told = JSON.parse(line);
        shown = told.shown;
        if (told.answers) called.shift()();
        if (!told.methods) continue;
        fill(own, device, told.methods);
        await server.start();
        console.log("ready", server.endpoints[0].port);
    }
    process.exit(0);
}

main().catch((error) => {
    console.error(error);
    process.exit(1);
});
