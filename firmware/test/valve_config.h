// valve_1, written by `arboleda firmware-config`; change its plant file or its wiring, not this.
#pragma once

#include "device.h"

namespace arboleda {

constexpr char kDeviceName[] = "valve_1";

constexpr Choice kChoices0[] = {
    {"closed", 0.0},
    {"open", 0.0}};
constexpr FactSpec kFactSpecs1[] = {
    {"lid", {ValueType::kText, list(kChoices0), -1000000000.0, 1000000000.0}, Source::kTold, {{}, false, 0.0}, 0, 0.0},
    {"ml", {ValueType::kNumber, {}, -1000000000.0, 1000000000.0}, Source::kTold, {{}, false, 0.0}, 0, 0.0}};
constexpr Setting kSettings2[] = {
    {0, {1.0, -1, nullptr}}};
constexpr Setting kSettings3[] = {
    {0, {0.0, -1, nullptr}}};
constexpr Choice kChoices4[] = {
    {nullptr, 5.0},
    {nullptr, 10.0}};
constexpr Parameter kParameters5[] = {
    {"ml", {ValueType::kWhole, list(kChoices4), -4294967295.0, 4294967295.0}}};
constexpr double kDoubles6[] = {
    5.0,
    10.0};
constexpr Setting kSettings7[] = {
    {1, {0.0, 0, kDoubles6}}};
constexpr Need kNeeds8[] = {
    {0, 1.0}};
constexpr Choice kChoices9[] = {
    {"enough", 0.0},
    {"low", 0.0}};
constexpr VerbSpec kVerbSpecs10[] = {
    {"open", Effect::kMotion, {}, list(kSettings2), {}, {}, {}, {}, ValueType::kText, {{}, false, 0.0}, 500000, 5000000, 500000, false, -1},
    {"close", Effect::kMotion, {}, list(kSettings3), {}, {}, {}, {}, ValueType::kText, {{}, false, 0.0}, 500000, 5000000, 500000, false, -1},
    {"dose", Effect::kProcess, list(kParameters5), list(kSettings7), list(kNeeds8), {}, {}, {}, ValueType::kText, {{}, false, 0.0}, 1500000, 10000000, 1500000, false, -1},
    {"level", Effect::kQuery, {}, {}, {}, {}, {}, list(kChoices9), ValueType::kText, {{}, true, 0.0}, 200000, 5000000, 200000, false, -1}};

constexpr Device kDevice = {list(kFactSpecs1), list(kVerbSpecs10), {}, {}, {}, {}};

}  // namespace arboleda
