// What the port uses of FreeRTOS, for a syntax check only.
#pragma once

#include <stdint.h>

using TaskHandle_t = void*;

int xTaskCreatePinnedToCore(void (*body)(void*), const char* name, uint32_t stack_bytes, void* argument,
                            unsigned priority, TaskHandle_t* task, int core);
void vTaskDelay(uint32_t ticks);
void vTaskDelete(TaskHandle_t task);
