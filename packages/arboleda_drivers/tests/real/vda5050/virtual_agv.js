// A vehicle of vda-5050-lib at a broker: node virtual_agv.js FOLDER URL SERIAL; FOLDER is where the library is.
// It prints `ready 0`, then `begin EDGE AT`, `end EDGE AT`, and `drop EDGE AT` where a stop ends its way.
"use strict";

const [folder, brokerUrl, serialNumber] = process.argv.slice(2);
const { AgvController, VirtualAgvAdapter } = require(folder);

const action = (actionType, actionScopes, ...needs) => ({
    actionType,
    actionScopes,
    actionParameters: [...needs, "duration"].map((key) => ({
        key,
        valueDataType: "STRING",
        isOptional: key === "duration",
    })),
});

// It has none of its own; this one is true of it, but for the limit of an order.
const FACTSHEET = {
    typeSpecification: {
        seriesName: "virtual",
        agvKinematic: "DIFF",
        agvClass: "CARRIER",
        maxLoadMass: 50,
        localizationTypes: ["NATURAL"],
        navigationTypes: ["VIRTUAL_LINE_GUIDED"],
    },
    physicalParameters: {
        speedMin: 0,
        speedMax: 1,
        accelerationMax: 1,
        decelerationMax: 1,
        heightMin: 0.3,
        heightMax: 0.3,
        width: 0.4,
        length: 0.6,
    },
    protocolLimits: {
        maxStringLens: {},
        maxArrayLens: { "order.nodes": 3 },
        timing: { minOrderInterval: 0, minStateInterval: 0 },
    },
    protocolFeatures: {
        optionalParameters: [],
        agvActions: [
            ...["cancelOrder", "startPause", "stopPause"].map((name) => action(name, ["INSTANT"])),
            ...["noop", "startCharging", "stopCharging"].map((name) => action(name, ["INSTANT", "NODE", "EDGE"])),
            action("pick", ["NODE"], "stationType", "loadType"),
        ],
    },
    agvGeometry: {},
    loadSpecification: {},
};

class Adapter extends VirtualAgvAdapter {
    traverseEdge(context) {
        this.edge = context.edge.edgeId;
        this.say("begin");
        const edgeTraversed = () => {
            this.say("end");
            context.edgeTraversed();
        };
        super.traverseEdge({ ...context, edgeTraversed });
    }

    stopTraverse(context) {
        this.say("drop");
        super.stopTraverse(context);
    }

    say(word) {
        console.log(word, this.edge, Number(process.hrtime.bigint()) / 1e9);
    }
}

class Vehicle extends AgvController {
    updateFactsheet() {
        super.updateFactsheet(FACTSHEET);
    }
}

const vehicle = new Vehicle(
    { manufacturer: "peer", serialNumber },
    { interfaceName: "uagv", transport: { brokerUrl }, vdaVersion: "2.0.0" },
    { agvAdapterType: Adapter, publishVisualizationInterval: 0, publishStateInterval: 2000 },
    {
        initialPosition: { mapId: "map", x: 0, y: 0, theta: 0, lastNodeId: "0" },
        initialBatteryCharge: 50,
        vehicleSpeed: 1,
        tickRate: 50,
    },
);
vehicle.start().then(() => console.log("ready", 0));
