// The storage recipe as a tree of BehaviorTree.CPP that waits for events, not for a tick.
//
// Lines in: `task` begins one, `done` ends the step that was told last. Lines out: `do KIND` begins a step,
// `end` says that the task is over. A thread reads; it wakes the tree by `emitWakeUpSignal`, and the main
// thread, asleep in `Tree::sleep`, ticks it. Nothing is checked, kept or shown: the least such a node does.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <iostream>
#include <mutex>
#include <string>
#include <thread>
#include <unistd.h>

#include "behaviortree_cpp/bt_factory.h"

namespace {

constexpr auto PATIENCE = std::chrono::hours(1);
constexpr const char* RECIPE = R"(
<root BTCPP_format="4" main_tree_to_execute="Storage">
  <BehaviorTree ID="Storage">
    <Sequence>
      <Step kind="drive"/>
      <Step kind="drive"/>
      <Step kind="move"/>
      <Step kind="switch"/>
      <Step kind="move"/>
      <Step kind="switch"/>
      <Step kind="move"/>
    </Sequence>
  </BehaviorTree>
</root>)";

void say(const std::string& line) {
  const std::string text = line + "\n";
  if (write(STDOUT_FILENO, text.data(), text.size()) < 0) {
    std::_Exit(1);
  }
}

// What the reading thread leaves for the tree.
struct Mail {
  std::mutex lock;
  std::condition_variable news;
  int tasks = 0;
  bool over = false;
  std::atomic<bool> done{false};
};

Mail mail;

class Step : public BT::StatefulActionNode {
public:
  Step(const std::string& name, const BT::NodeConfig& config) : StatefulActionNode(name, config) {}

  static BT::PortsList providedPorts() { return {BT::InputPort<std::string>("kind")}; }

  BT::NodeStatus onStart() override {
    mail.done = false;
    say("do " + getInput<std::string>("kind").value());
    return BT::NodeStatus::RUNNING;
  }

  BT::NodeStatus onRunning() override {
    return mail.done ? BT::NodeStatus::SUCCESS : BT::NodeStatus::RUNNING;
  }

  void onHalted() override {}
};

void hear(BT::Tree& tree) {
  for (std::string line; std::getline(std::cin, line);) {
    if (line == "done") {
      mail.done = true;
      tree.rootNode()->emitWakeUpSignal();
    } else {
      const std::lock_guard<std::mutex> held(mail.lock);
      ++mail.tasks;
      mail.news.notify_one();
    }
  }
  const std::lock_guard<std::mutex> held(mail.lock);
  mail.over = true;
  mail.news.notify_one();
}

bool await_task() {
  std::unique_lock<std::mutex> held(mail.lock);
  mail.news.wait(held, [] { return mail.tasks > 0 || mail.over; });
  return mail.tasks-- > 0;
}

}  // namespace

int main() {
  std::ios::sync_with_stdio(false);
  BT::BehaviorTreeFactory factory;
  factory.registerNodeType<Step>("Step");
  BT::Tree tree = factory.createTreeFromText(RECIPE);
  std::thread reader(hear, std::ref(tree));
  reader.detach();
  while (await_task()) {
    while (tree.tickExactlyOnce() == BT::NodeStatus::RUNNING) {
      tree.sleep(std::chrono::duration_cast<std::chrono::milliseconds>(PATIENCE));
    }
    say("end");
  }
  return 0;
}
