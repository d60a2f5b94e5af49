// What the port uses of FreeRTOS, for a syntax check only.
#pragma once
