// press_1, written by `arboleda firmware-config`; change its plant file or its wiring, not this.
#pragma once

#include "device.h"

namespace arboleda {

constexpr char kDeviceName[] = "press_1";

constexpr Condition kConditions0[] = {
    {0, true}};
constexpr Condition kConditions1[] = {
    {1, true}};
constexpr Row kRows2[] = {
    {1.0, list(kConditions0)},
    {0.0, list(kConditions1)}};
constexpr Choice kChoices3[] = {
    {"closed", 0.0},
    {"open", 0.0},
    {"between", 0.0}};
constexpr Condition kConditions4[] = {
    {2, true}};
constexpr Row kRows5[] = {
    {1.0, list(kConditions4)}};
constexpr Condition kConditions6[] = {
    {3, true}};
constexpr Row kRows7[] = {
    {1.0, list(kConditions6)}};
constexpr Condition kConditions8[] = {
    {4, true}};
constexpr Row kRows9[] = {
    {1.0, list(kConditions8)}};
constexpr Choice kChoices10[] = {
    {nullptr, 1.0},
    {nullptr, 2.0}};
constexpr FactSpec kFactSpecs11[] = {
    {"gate", {ValueType::kText, list(kChoices3), -1000000000.0, 1000000000.0}, Source::kInputs, {list(kRows2), true, 2.0}, 0, 0.0},
    {"clamped", {ValueType::kBool, {}, -1000000000.0, 1000000000.0}, Source::kInputs, {list(kRows5), true, 0.0}, 0, 0.0},
    {"part", {ValueType::kBool, {}, -1000000000.0, 1000000000.0}, Source::kInputs, {list(kRows7), true, 0.0}, 0, 0.0},
    {"pressed", {ValueType::kBool, {}, -1000000000.0, 1000000000.0}, Source::kInputs, {list(kRows9), true, 0.0}, 0, 0.0},
    {"bar", {ValueType::kNumber, {}, -1000000000.0, 1000000000.0}, Source::kAnalog, {{}, false, 0.0}, 0, 0.0},
    {"program", {ValueType::kWhole, list(kChoices10), -4294967295.0, 4294967295.0}, Source::kTold, {{}, false, 0.0}, 0, 0.0}};
constexpr Setting kSettings12[] = {
    {0, {1.0, -1, nullptr}}};
constexpr Action kActions13[] = {
    {Drive::kServo, 0, {90.0, -1, nullptr}}};
constexpr Setting kSettings14[] = {
    {0, {0.0, -1, nullptr}}};
constexpr Action kActions15[] = {
    {Drive::kServo, 0, {0.0, -1, nullptr}}};
constexpr Parameter kParameters16[] = {
    {"on", {ValueType::kBool, {}, -1000000000.0, 1000000000.0}}};
constexpr Setting kSettings17[] = {
    {1, {0.0, 0, nullptr}}};
constexpr Action kActions18[] = {
    {Drive::kOutput, 0, {0.0, 0, nullptr}}};
constexpr Choice kChoices19[] = {
    {nullptr, 1.0},
    {nullptr, 2.0}};
constexpr Parameter kParameters20[] = {
    {"program", {ValueType::kWhole, list(kChoices19), -4294967295.0, 4294967295.0}}};
constexpr double kDoubles21[] = {
    0.0,
    1.0};
constexpr Setting kSettings22[] = {
    {3, {1.0, -1, nullptr}},
    {5, {0.0, 0, kDoubles21}}};
constexpr Need kNeeds23[] = {
    {0, 0.0},
    {1, 1.0}};
constexpr Action kActions24[] = {
    {Drive::kOutput, 2, {0.0, -1, nullptr}},
    {Drive::kOutput, 1, {1.0, -1, nullptr}}};
constexpr Action kActions25[] = {
    {Drive::kOutput, 1, {0.0, -1, nullptr}}};
constexpr Setting kSettings26[] = {
    {3, {0.0, -1, nullptr}}};
constexpr Action kActions27[] = {
    {Drive::kOutput, 2, {1.0, -1, nullptr}}};
constexpr Choice kChoices28[] = {
    {"present", 0.0},
    {"absent", 0.0}};
constexpr Condition kConditions29[] = {
    {3, true}};
constexpr Row kRows30[] = {
    {0.0, list(kConditions29)}};
constexpr VerbSpec kVerbSpecs31[] = {
    {"open", Effect::kMotion, {}, list(kSettings12), {}, list(kActions13), {}, {}, ValueType::kText, {{}, false, 0.0}, 0, 4000000, 800000, false, -1},
    {"close", Effect::kMotion, {}, list(kSettings14), {}, list(kActions15), {}, {}, ValueType::kText, {{}, false, 0.0}, 0, 4000000, 800000, false, -1},
    {"clamp", Effect::kSwitch, list(kParameters16), list(kSettings17), {}, list(kActions18), {}, {}, ValueType::kText, {{}, false, 0.0}, 0, 3000000, 300000, false, 1},
    {"press", Effect::kProcess, list(kParameters20), list(kSettings22), list(kNeeds23), list(kActions24), list(kActions25), {}, ValueType::kText, {{}, false, 0.0}, 0, 10000000, 2000000, false, -1},
    {"relieve", Effect::kMotion, {}, list(kSettings26), {}, list(kActions27), {}, {}, ValueType::kText, {{}, false, 0.0}, 0, 5000000, 500000, false, -1},
    {"look", Effect::kQuery, {}, {}, {}, {}, {}, list(kChoices28), ValueType::kText, {list(kRows30), true, 1.0}, 100000, 2000000, 100000, false, -1}};
constexpr InputWiring kInputWirings32[] = {
    {"gate_up", 34, true, 20000, -1, 0.0, 0.0},
    {"gate_down", 35, true, 20000, -1, 0.0, 0.0},
    {"clamp_in", 36, true, 30000, -1, 0.0, 0.0},
    {"part_in", 39, false, 20000, -1, 0.0, 0.0},
    {"at_force", -1, false, 20000, 0, 4.2, 3.8}};
constexpr OutputWiring kOutputWirings33[] = {
    {"clamp", 25, false, false, false},
    {"pump", 26, false, false, true},
    {"relief", 27, false, true, true}};
constexpr ServoWiring kServoWirings34[] = {
    {"gate", 32, 0.0, 90.0, 1000, 2000, 120.0}};
constexpr AnalogWiring kAnalogWirings35[] = {
    {"pressure", 33, -1.2515262515262515, 0.0030525030525030525, 0.1, 200, 3900}};

constexpr Device kDevice = {list(kFactSpecs11), list(kVerbSpecs31), list(kInputWirings32), list(kOutputWirings33), list(kServoWirings34), list(kAnalogWirings35)};

}  // namespace arboleda
