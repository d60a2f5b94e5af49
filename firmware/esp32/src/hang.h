// A watch over the task on core 1: where it hangs for a second, the processor resets.
#pragma once

namespace arboleda {

void watch_for_hangs();  // by the task itself, before its first turn
void turned();           // after each of its turns

}  // namespace arboleda
