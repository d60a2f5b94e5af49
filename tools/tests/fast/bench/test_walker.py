"""Walker over floors of all kinds."""

from arboleda_bench.walker import Walker


class Spoken(Walker[str]):
    """Keeps what it publishes; its pauses are over when the test says so."""

    def __init__(self) -> None:
        super().__init__(["out", "back"], pause_s=0.5)
        self.said: list[str] = []
        self.pauses: list[float] = []

    def publish(self, step: str) -> None:
        self.said.append(step)

    def go_on_after(self, seconds: float) -> None:
        self.pauses.append(seconds)


def test_a_task_begins_after_its_pause():
    walker = Spoken()
    walker.task()
    assert (walker.said, walker.pauses) == ([], [0.5])


def test_steps_come_one_by_one():
    walker = Spoken()
    walker.task()
    walker.go_on()
    assert walker.said == ["out"]
    walker.go_on()
    assert walker.said == ["out", "back"]


def test_a_second_task_waits_for_the_end_of_the_first():
    walker = Spoken()
    walker.task()
    walker.task()
    for _ in range(3):
        walker.go_on()
    assert (walker.said, walker.pauses) == (["out", "back"], [0.5, 0.5])
    walker.go_on()
    assert walker.said == ["out", "back", "out"]


def test_nothing_follows_the_last_task():
    walker = Spoken()
    walker.task()
    for _ in range(3):
        walker.go_on()
    assert (walker.said, walker.pauses) == (["out", "back"], [0.5])
