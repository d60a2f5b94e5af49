"""Factsheet of a virtual vehicle, in the form of each version of VDA 5050."""

from __future__ import annotations

from typing import Any

NODE, INSTANT, EDGE = "NODE", "INSTANT", "EDGE"
ACTIONS: dict[str, tuple[str, ...]] = {
    "pick": (NODE,),
    "drop": (NODE, INSTANT),
    "detectObject": (NODE, EDGE),
    "startCharging": (NODE, INSTANT),
    "stopCharging": (NODE, INSTANT),
    "cancelOrder": (INSTANT,),
    "startPause": (INSTANT,),
    "stopPause": (INSTANT,),
    "stateRequest": (INSTANT,),
    "factsheetRequest": (INSTANT,),
}
VALUES = {"pick": "height"}  # parameters that are optional


def factsheet_of(version: str) -> dict[str, Any]:
    """The body of a factsheet message; it has no limits, and its sizes are those of a small cart."""
    return _OF_3 if version == "3.0" else _OF_2


def _action(name: str) -> dict[str, Any]:
    value = VALUES.get(name)
    parameters = [] if value is None else [{"key": value, "valueDataType": "NUMBER", "isOptional": True}]
    return {"actionType": name, "actionScopes": list(ACTIONS[name]), "actionParameters": parameters}


_OF_2: dict[str, Any] = {
    "typeSpecification": {
        "seriesName": "virtual",
        "agvKinematic": "DIFF",
        "agvClass": "CARRIER",
        "maxLoadMass": 50.0,
        "localizationTypes": ["NATURAL"],
        "navigationTypes": ["VIRTUAL_LINE_GUIDED"],
    },
    "physicalParameters": {
        "speedMin": 0.0,
        "speedMax": 0.5,
        "accelerationMax": 1.0,
        "decelerationMax": 1.0,
        "heightMax": 0.3,
        "width": 0.4,
        "length": 0.6,
    },
    "protocolLimits": {
        "maxStringLens": {},
        "maxArrayLens": {},
        "timing": {"minOrderInterval": 0.0, "minStateInterval": 0.0},
    },
    "protocolFeatures": {"optionalParameters": [], "agvActions": [_action(name) for name in ACTIONS]},
    "agvGeometry": {},
    "loadSpecification": {},
}
_OF_3: dict[str, Any] = {
    "typeSpecification": {
        "seriesName": "virtual",
        "mobileRobotKinematic": "DIFFERENTIAL",
        "mobileRobotClass": "CARRIER",
        "maximumLoadMass": 50.0,
        "localizationTypes": ["NATURAL"],
        "navigationTypes": ["VIRTUAL_LINE_GUIDED"],
    },
    "physicalParameters": {
        "minimumSpeed": 0.0,
        "maximumSpeed": 0.5,
        "maximumAcceleration": 1.0,
        "maximumDeceleration": 1.0,
        "minimumHeight": 0.3,
        "maximumHeight": 0.3,
        "width": 0.4,
        "length": 0.6,
    },
    "protocolLimits": {
        "maximumStringLengths": {},
        "maximumArrayLengths": {},
        "timing": {"minimumOrderInterval": 0.0, "minimumStateInterval": 0.0},
    },
    "protocolFeatures": {
        "optionalParameters": [],
        "mobileRobotActions": [
            {**_action(name), "pauseAllowed": "false", "cancelAllowed": "true"} for name in ACTIONS
        ],
    },
    "mobileRobotGeometry": {},
    "loadSpecification": {},
}
