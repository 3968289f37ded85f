"""All scenes: who makes each, how many triangles it must have, how its reference is rendered."""
from dataclasses import dataclass
from typing import Callable

from . import animal, arena, atrium, buildings, room, small, street


@dataclass(frozen=True)
class Entry:
    make: Callable          # () or (albedo=) -> glb.Scene, or the file's bytes
    triangles: tuple        # least and most allowed
    spp: int                # of the committed reference
    albedo: float = None    # default of --albedo, for scenes that have one
    committed: bool = True  # False: made by the build
    one_bounce_spp: int = None  # of a committed reference with one reflection, for techniques that stop there
    cycles: str = None      # images of an unrelated renderer


def _exactly(n):
    return (n, n)


SCENES = {
    'cornell': Entry(small.reference_copy('cornell'), _exactly(30), 512, one_bounce_spp=1024,
                     cycles='data/reference/ref/cornell'),
    'thin_wall': Entry(small.reference_copy('thin_wall'), _exactly(42), 256, one_bounce_spp=512,
                       cycles='data/reference/ref/thin_wall'),
    'room': Entry(small.reference_copy('room'), _exactly(192), 1024, one_bounce_spp=4096,
                  cycles='data/reference/ref/room'),
    'room704': Entry(room.room704, _exactly(704), 1024),
    'convex_box': Entry(small.convex_box, _exactly(10), 256, one_bounce_spp=512),
    'closed_box': Entry(small.closed_box, _exactly(60), 128, albedo=0.7),
    'furnace': Entry(small.furnace, _exactly(12), 64, albedo=0.5),
    'occluder': Entry(small.occluder, _exactly(22), 1024, one_bounce_spp=1024),
    'corridor': Entry(small.corridor, (26, 60), 2048),
    'emissive': Entry(small.emissive, (1400, 1800), 512),
    'arena': Entry(arena.arena, (9500, 10500), 512, committed=False),
    'atrium': Entry(atrium.atrium, (65000, 67000), 512, committed=False),
    'atrium_detail': Entry(lambda: atrium.atrium(detail=True), (97000, 99000), 512, committed=False),
    'house': Entry(buildings.house, _exactly(4190), 4096, committed=False),
    'office': Entry(buildings.office, _exactly(1218), 512, committed=False),
    'steps': Entry(buildings.steps, _exactly(2400), 512, committed=False),
    'street': Entry(street.street, _exactly(17028), 256, committed=False),
    'bunny': Entry(animal.bunny, _exactly(69462), 1024, committed=False, one_bounce_spp=1024),
    'animal17k': Entry(animal.animal17k, _exactly(16998), 512, committed=False),
}
