import pytest
from exploring import explored

from bigraphs.errors import BigraphError
from bigraphs.examples import example_names, example_text
from bigraphs.notation import read_system, write_system

COUNTS = {
    "actors": (10, 12),  # two clients alike, each in one of four phases, one further a step
    "asynchronous_pi": (3, 2),
    "mobile_ambients": (4, 3),
    "oil_spill": (5, 12),  # how far the spill is ahead, 2 ways; how far the UAV is from its report, 3
    "sensor_network": (24, 40),
    "uav_patrol": (8, 20),
}


@pytest.mark.parametrize("name", example_names())
def test_an_example_has_its_states_and_steps(name):
    states, steps = explored(read_system(example_text(name)))
    assert (len(states), len(steps)) == COUNTS[name]


def counted(first, following, alike):
    """Return how many states and steps a direct model has, states that are `alike` taken as one."""
    states, steps, waiting = {alike(first)}, set(), [first]
    while waiting:
        state = waiting.pop()
        for found in following(state):
            steps.add((alike(state), alike(found)))
            if alike(found) not in states:
                states.add(alike(found))
                waiting.append(found)
    return len(states), len(steps)


def test_the_sensor_network_is_what_a_line_of_letters_does():
    def following(line):
        for place, mote in enumerate(line):
            if mote == "I":
                yield line[:place] + "S" + line[place + 1 :]
                for near in {place - 1, place + 1} & set(range(len(line))):
                    if line[near] == "U":
                        yield line[:near] + "I" + line[near + 1 :]

    def alike(line):
        return min(line, line[::-1])

    assert counted("IUUU", following, alike) == COUNTS["sensor_network"]


def test_the_patrol_is_what_pairs_of_place_and_station_do():
    def following(uavs):
        for number, (place, station) in enumerate(uavs):
            rest = uavs[:number] + uavs[number + 1 :]
            yield (*rest, (place, 1 - station))
            for near in {place - 1, place + 1} & {0, 1, 2}:
                yield (*rest, (near, station))

    def alike(uavs):
        turned = [[(2 - place, station) for place, station in uavs], list(uavs)]
        swapped = [[(place, 1 - station) for place, station in each] for each in turned]
        return min(tuple(sorted(each)) for each in (*turned, *swapped))

    assert counted(((0, 0), (0, 0)), following, alike) == COUNTS["uav_patrol"]


@pytest.mark.parametrize("name", example_names())
def test_an_example_explains_itself_and_is_written_and_read_back(name):
    text = example_text(name)
    assert text.startswith("# ")
    system = read_system(text)
    again = read_system(write_system(system))
    assert (again.kind, again.signature, again.actions) == (system.kind, system.signature, system.actions)
    assert write_system(again) == write_system(read_system(write_system(again)))


def test_an_example_that_is_not_there_is_told_with_those_that_are():
    with pytest.raises(BigraphError, match="there is no example 'ambients'") as found:
        example_text("ambients")
    assert "mobile_ambients" in found.value.hint
