// A client of node-opcua that browses a plant and tries to change it: node opcua_node_client.js FOLDER KEPT URL PATH
// TAG. FOLDER is where its packages are, KEPT where it may keep a certificate, PATH the id of a cell's node, TAG that
// of a variable below it. Prints JSON: what is below PATH with its values, what became of each try, and the first
// value of TAG that a subscription brings.
"use strict";

const [folder, kept, url, path, tag] = process.argv.slice(2);
const { OPCUAClient, AttributeIds, TimestampsToReturn } = require(`${folder}/node-opcua-client`);
const { OPCUACertificateManager } = require(`${folder}/node-opcua-certificate-manager`);
const { DataType } = require(`${folder}/node-opcua-variant`);
const { NodeClass } = require(`${folder}/node-opcua-data-model`);

async function below(session, node, found, at) {
    for (const each of (await session.browse(node)).references) {
        const here = [...at, each.browseName.name];
        if (each.nodeClass === NodeClass.Variable) {
            const read = await session.read({ nodeId: each.nodeId, attributeId: AttributeIds.Value });
            found[here.join("/")] = read.statusCode.isGood() ? read.value.value : read.statusCode.name;
        } else if (each.nodeClass === NodeClass.Object) await below(session, each.nodeId, found, here);
    }
    return found;
}

async function tried(act) {
    try {
        const said = await act();
        return said.name || (said.statusCode && said.statusCode.name) || String(said);
    } catch (error) {
        return (error.response && error.response.responseHeader.serviceResult.name) || error.message;
    }
}

async function watched(session) {
    const subscription = await session.createSubscription2({
        requestedPublishingInterval: 50,
        requestedMaxKeepAliveCount: 10,
        requestedLifetimeCount: 100,
        maxNotificationsPerPublish: 10,
        publishingEnabled: true,
        priority: 1,
    });
    const item = await subscription.monitor(
        { nodeId: tag, attributeId: AttributeIds.Value },
        { samplingInterval: 10, discardOldest: true, queueSize: 10 },
        TimestampsToReturn.Both,
    );
    const first = await new Promise((resolve) => item.once("changed", (value) => resolve(value.value.value)));
    await subscription.terminate();
    return first;
}

async function main() {
    const client = OPCUAClient.create({
        endpointMustExist: false,
        connectionStrategy: { maxRetry: 1 },
        clientCertificateManager: new OPCUACertificateManager({ rootFolder: kept }),
    });
    await client.connect(url);
    const session = await client.createSession();
    const value = { value: { dataType: DataType.Int32, value: 6 } };
    const said = {
        found: await below(session, path, {}, []),
        write: await tried(() => session.write({ nodeId: tag, attributeId: AttributeIds.Value, value })),
        call: await tried(() =>
            session.call({
                objectId: "i=2253",
                methodId: "i=11492",
                inputArguments: [{ dataType: DataType.UInt32, value: 1 }],
            }),
        ),
        watched: await watched(session),
    };
    await session.close();
    await client.disconnect();
    console.log(JSON.stringify(said));
}

main().catch((error) => {
    console.error(error);
    process.exit(1);
});
