// A test macro of our own: a test is a function that registers itself; a failed CHECK names its line.
#pragma once

#include <stdio.h>

namespace check {

struct Test {
    Test(const char* called, void (*runs)()) : name(called), body(runs), next(first()) { first() = this; }

    static Test*& first() {
        static Test* head = nullptr;
        return head;
    }

    const char* name;
    void (*body)();
    Test* next;
};

inline int& failures() {
    static int count = 0;
    return count;
}

inline void fail(const char* file, int line, const char* what) {
    ++failures();
    fprintf(stderr, "%s:%d: not so: %s\n", file, line, what);
}

inline int run() {
    int count = 0;
    for (Test* test = Test::first(); test != nullptr; test = test->next, ++count) {
        const int before = failures();
        test->body();
        if (failures() > before) {
            fprintf(stderr, "FAILED %s\n", test->name);
        }
    }
    printf("%d tests, %d failed checks\n", count, failures());
    return failures() == 0 && count > 0 ? 0 : 1;
}

}  // namespace check

#define CHECK(what) ((what) ? (void)0 : check::fail(__FILE__, __LINE__, #what))
#define TEST(name)                                  \
    static void name();                             \
    static const check::Test name##_test(#name, name); \
    static void name()
