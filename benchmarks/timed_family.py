"""The timed family: UAVs that each go round places of their own and come home, on batteries that just last."""


def text(uavs: int, places: int, tick: int = 10, scheduler: str = "fcfs") -> str:
    """Write the mission of so many UAVs, each with so many places to go to, in ticks of so many seconds."""
    world, programs, timing = [], [], []
    for i in range(uavs):
        west = -8.5 + 0.2 * i
        names = [f"place{i}_{k}" for k in range(places)]
        for k, name in enumerate((f"home{i}", *names)):
            south = 37.0 + 0.05 * k + 0.005 * i
            world.append(f"  {name}: Location = circle ({south:.3f}, {west:.3f}) radius 500 m")
        world.append(f"  uav{i}: UAV = point ({37.0 + 0.005 * i:.3f}, {west:.3f})")
        programs.append(
            f"BigActor patrol{i} hosted_at uav{i} with_behavior {{\n"
            f"  for place in [{', '.join([*names, f'home{i}'])}] {{\n    control(MOVE_HOST_TO place)\n  }}\n}}\n"
        )
        timing.append(f"  uav{i} flies at {18 + i} m/s to 25 m/s\n  uav{i} lasts 60 min, restored in home{i}")
    return "\n".join(
        [
            f"mission timed_family_{uavs}_{places}\n",
            "signature {\n  kind Location contains Location, UAV\n  kind UAV driven\n}\n",
            "world {\n" + "\n".join(world) + "\n}\n",
            "\n".join(programs),
            f"scheduler {scheduler}\ncontrol timed\n",
            f"timing {{\n  tick {tick} s\n" + "\n".join(timing) + f"\n  agents react within {tick} s\n}}\n",
            "check {\n  endurance\n"
            + "".join(
                f'  within 2 h "there{i}": actually uav{i} in place{i}_{places - 1}\n' for i in range(uavs)
            )
            + "}\n",
        ]
    )
