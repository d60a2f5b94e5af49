// The board of a declared device as a program: the core, a device that is not there, a real broker.
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "../../core/keepsakes.h"
#include "../link.h"
#include "../program.h"
#include "world.h"

namespace {

using namespace arboleda;

constexpr int kBadInput = 2;

constexpr char kHelp[] =
    "device_board [--name NAME] [--broker HOST:PORT] ...\n"
    "The board of the device that device_config.h describes, on MQTT, with a device that is not there.\n\n"
    "  --name NAME          its name on MQTT; default: that of the plant file\n"
    "  --broker HOST:PORT   default 127.0.0.1:1883; login from $ARBOLEDA_MQTT_USER, $ARBOLEDA_MQTT_PASSWORD\n"
    "  --until-eof          end with the standard input\n"
    "On its standard input it takes faults; `help` lists them.\n";

constexpr char kFaults[] =
    "reboot             power lost and back\n"
    "input NAME 0|1     a hand holds it off or on\n"
    "counts NAME N      the converter of an analog input says so\n"
    "stick 0|1          nothing follows what is driven\n"
    "fail, repair       an alarm, and its end\n"
    "mute S             it goes on, and publishes nothing\n"
    "stall MS           its loop hangs so long\n"
    "state              what it drives\n"
    "quit               end\n";

bool is(const char* word, const char* known) { return strcmp(word, known) == 0; }

template <typename Wiring>
int place_of(const List<Wiring>& wirings, const char* name) {
    for (uint8_t at = 0; at < wirings.count; ++at) {
        if (is(wirings[at].name, name)) {
            return at;
        }
    }
    return -1;
}

class Program final : public DeviceVoice {
public:
    explicit Program(const Options& options) : options_(options), link_(options) {
        board_.boot(now_us(), next_boot_id());
    }

    int run();
    void present() override { link_.present("1"); }
    void tell(const DeviceTelemetry& said) override {
        if (now_us() >= muted_until_us_) {
            link_.tell(said);
        }
    }

private:
    void catch_up(uint64_t until_us);
    void wait();
    void hear();
    void obey(const char* line);
    bool put(const char* word, const char* name, int value);
    void say_state() const;
    uint64_t next_us() const {
        return board_.next_us() < world_.next_us() ? board_.next_us() : world_.next_us();
    }
    uint32_t next_boot_id() { return boot_id(boots_++, static_cast<uint32_t>(rand())); }

    const Options& options_;
    DeviceWorld world_{kDevice};
    Link link_;
    DeviceBoard board_{kDevice, world_, *this};
    uint32_t boots_ = static_cast<uint32_t>(time(nullptr));
    uint64_t muted_until_us_ = 0;
    Lines lines_;
    bool over_ = false;
};

int Program::run() {
    if (!link_.start()) {
        return 1;
    }
    while (!ended() && !over_) {
        wait();
        catch_up(now_us());
        hear();
    }
    return 0;
}

void Program::catch_up(uint64_t until_us) {
    while (next_us() <= until_us) {
        const uint64_t due_us = next_us();
        world_.advance(due_us, board_.working());
        board_.poll(due_us);
    }
    world_.advance(until_us, board_.working());
    board_.poll(until_us);
}

void Program::wait() {
    const char* line = lines_.wait(link_.wake_fd(), next_us());
    over_ = over_ || (lines_.over() && options_.until_eof);
    if (line != nullptr) {
        catch_up(now_us());
        obey(line);
        fflush(stdout);
    }
}

void Program::hear() {
    Heard heard;
    while (link_.take(&heard)) {
        const uint64_t now = now_us();
        catch_up(now);
        if (heard.what != Heard::What::kMessage) {
            board_.connect(now, heard.what == Heard::What::kUp);
        } else if (heard.message.is_order) {
            board_.receive(now, heard.message.order);
        } else {
            board_.receive(now, heard.message.message);
        }
    }
}

// `input NAME 0|1`, `counts NAME N`; false where there is no such input.
bool Program::put(const char* word, const char* name, int value) {
    const bool analog = is(word, "counts");
    const int at = analog ? place_of(kDevice.analogs, name) : place_of(kDevice.inputs, name);
    if (at < 0 || value < 0 || value > (analog ? 4095 : 1)) {
        return false;
    }
    if (analog) {
        world_.set_counts(static_cast<uint8_t>(at), static_cast<uint16_t>(value));
    } else {
        world_.put(static_cast<uint8_t>(at), value != 0);
    }
    return true;
}

void Program::obey(const char* line) {
    char word[16] = "";
    char name[40] = "";
    int value = 0;
    const int read = sscanf(line, "%15s %39s %d", word, name, &value);
    const int first = atoi(name);
    if (read < 1) {
        return;
    }
    if (is(word, "quit")) {
        over_ = true;
    } else if (is(word, "reboot")) {
        board_.boot(now_us(), next_boot_id());
    } else if (is(word, "fail")) {
        board_.fail(now_us());
    } else if (is(word, "repair")) {
        board_.repair(now_us());
    } else if (is(word, "stick") && read == 2) {
        world_.stuck = first != 0;
    } else if (is(word, "mute") && first > 0) {
        muted_until_us_ = now_us() + static_cast<uint64_t>(first) * kUsPerS;
    } else if (is(word, "stall") && first > 0) {
        usleep(static_cast<useconds_t>(first) * 1000U);
    } else if (is(word, "state")) {
        say_state();
    } else if (read < 3 || (!is(word, "input") && !is(word, "counts")) || !put(word, name, value)) {
        printf("%s", kFaults);
    }
}

void Program::say_state() const {
    for (uint8_t at = 0; at < kDevice.outputs.count; ++at) {
        printf("%s %s\n", kDevice.outputs[at].name, world_.output(at) ? "high" : "low");
    }
    for (uint8_t at = 0; at < kDevice.servos.count; ++at) {
        printf("%s %u us\n", kDevice.servos[at].name, world_.pulse_us(at));
    }
    printf("estado %d, refused %lu\n", static_cast<int>(board_.state()),
           static_cast<unsigned long>(board_.refusals()));
}

constexpr option kOptions[] = {{"name", required_argument, nullptr, 'n'},
                               {"broker", required_argument, nullptr, 'b'},
                               {"until-eof", no_argument, nullptr, 'e'},
                               {"help", no_argument, nullptr, 'h'},
                               {nullptr, 0, nullptr, 0}};

// False: a sentence was said, or the help.
bool read_device_options(int count, char** words, Options* options, int* status) {
    *status = kBadInput;
    options->robot = kDeviceName;
    opterr = 0;
    for (int letter = 0; (letter = getopt_long(count, words, "", kOptions, nullptr)) != -1;) {
        if (letter == 'h') {
            fputs(kHelp, stdout);
            *status = 0;
            return false;
        }
        if (letter == 'e') {
            options->until_eof = true;
        } else if (letter == 'n') {
            options->robot = optarg;
            if (!good_name(optarg)) {
                return refuse("--name", optarg, "1 to 64 of A-Z a-z 0-9 _ -");
            }
        } else if (letter != 'b') {
            return refuse("an option", words[optind - 1], "see device_board --help");
        } else if (!read_broker(optarg, options)) {
            return false;
        }
    }
    return optind == count || refuse("an argument", words[optind], "none; see device_board --help");
}

}  // namespace

int main(int count, char** words) {
    Options options;
    int status = 0;
    if (!read_device_options(count, words, &options, &status)) {
        return status;
    }
    begin_program();
    Program program(options);
    return program.run();
}
