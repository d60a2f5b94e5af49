// A vehicle of vda-5050-lib at a broker: node virtual_agv.js FOLDER URL SERIAL; FOLDER is where the library is.
"use strict";

const [folder, brokerUrl, serialNumber] = process.argv.slice(2);
const { AgvController, VirtualAgvAdapter } = require(folder);

const vehicle = new AgvController(
    { manufacturer: "peer", serialNumber },
    { interfaceName: "uagv", transport: { brokerUrl }, vdaVersion: "2.0.0" },
    { agvAdapterType: VirtualAgvAdapter, publishVisualizationInterval: 0, publishStateInterval: 2000 },
    {
        initialPosition: { mapId: "map", x: 0, y: 0, theta: 0, lastNodeId: "0" },
        initialBatteryCharge: 50,
        vehicleSpeed: 1,
        tickRate: 50,
    },
);
vehicle.start();
