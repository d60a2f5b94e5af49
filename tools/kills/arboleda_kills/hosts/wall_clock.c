/* A wall clock of its own for one host: preloaded into each of its processes (cc -shared -fPIC; LD_PRELOAD).

   What tells the time of day is ahead by the nanoseconds that stand in the file of $ARBOLEDA_WALL_CLOCK, which
   whoever steps that clock writes at any time. Clocks that nobody sets stay as they are. Who waits until a time of
   day waits as long as it was meant when the wait began. */

#define _GNU_SOURCE
#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <semaphore.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#define NS 1000000000L
#define MONOTONIC_CONDITION 2u /* of __wrefs, in glibc */
#define NEXT(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

static const volatile int64_t *ahead_ns;

__attribute__((constructor)) static void look_up(void) {
    const char *path = getenv("ARBOLEDA_WALL_CLOCK");
    int file = path ? open(path, O_RDONLY | O_CLOEXEC) : -1;
    void *page = file < 0 ? MAP_FAILED : mmap(NULL, sizeof *ahead_ns, PROT_READ, MAP_SHARED, file, 0);
    if (page == MAP_FAILED) {
        perror("wall_clock: $ARBOLEDA_WALL_CLOCK");
        _exit(127);
    }
    close(file);
    ahead_ns = page;
}

static struct timespec moved(struct timespec at, int64_t ns) {
    int64_t rest = at.tv_nsec + ns % NS;
    at.tv_sec += ns / NS + (rest >= NS) - (rest < 0);
    at.tv_nsec = rest + (rest < 0 ? NS : 0) - (rest >= NS ? NS : 0);
    return at;
}

static int64_t ahead(void) { return ahead_ns ? *ahead_ns : 0; }

static struct timespec truly(const struct timespec *at) { return moved(*at, -ahead()); }

int clock_gettime(clockid_t clock, struct timespec *at) {
    static __typeof__(&clock_gettime) next;
    if (!next) next = NEXT(clock_gettime);
    int failed = next(clock, at);
    if (!failed && (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE)) *at = moved(*at, ahead());
    return failed;
}

int gettimeofday(struct timeval *restrict at, void *restrict zone) {
    struct timespec now;
    (void)zone; /* no Linux has one */
    clock_gettime(CLOCK_REALTIME, &now);
    *at = (struct timeval){.tv_sec = now.tv_sec, .tv_usec = now.tv_nsec / 1000};
    return 0;
}

time_t time(time_t *at) {
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    if (at) *at = now.tv_sec;
    return now.tv_sec;
}

int pthread_cond_timedwait(
    pthread_cond_t *restrict condition, pthread_mutex_t *restrict mutex, const struct timespec *restrict until) {
    struct timespec then = condition->__data.__wrefs & MONOTONIC_CONDITION ? *until : truly(until);
    return NEXT(pthread_cond_timedwait)(condition, mutex, &then);
}

int pthread_mutex_timedlock(pthread_mutex_t *restrict mutex, const struct timespec *restrict until) {
    struct timespec then = truly(until);
    return NEXT(pthread_mutex_timedlock)(mutex, &then);
}

int sem_timedwait(sem_t *restrict semaphore, const struct timespec *restrict until) {
    struct timespec then = truly(until);
    return NEXT(sem_timedwait)(semaphore, &then);
}

int clock_nanosleep(clockid_t clock, int flags, const struct timespec *until, struct timespec *rest) {
    struct timespec then = clock == CLOCK_REALTIME && flags & TIMER_ABSTIME ? truly(until) : *until;
    return NEXT(clock_nanosleep)(clock, flags, &then, rest);
}
