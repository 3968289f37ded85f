"""Albedo textures: few colours each, so that they are small; linear albedos between 0.4 and 0.85."""
import random

from . import png

SIZE = 256


def _grain(seed, levels):
    dice = random.Random(seed)
    table = [dice.random() for _ in range(SIZE * SIZE)]
    return lambda x, y: int(table[y * SIZE + x] * levels) / levels - 0.5


def _courses(columns, rows, joint, faces, mortar, seed):
    """Masonry in running bond: `faces` are the colours that its stones have, `mortar` that of the joints."""
    dice = random.Random(seed)
    choice = [[dice.choice(faces) for _ in range(columns)] for _ in range(rows)]
    grain = _grain(seed + 1, 5)
    width, height = SIZE // columns, SIZE // rows

    def pixel(x, y):
        row = y // height
        shifted = (x + (row % 2) * width // 2) % SIZE
        in_joint = y % height < joint or shifted % width < joint
        colour = mortar if in_joint else choice[row][shifted // width]
        g = 1 + 0.06 * grain(x, y)
        return tuple(c * g for c in colour)

    return png.encode(SIZE, SIZE, pixel)


def brick():
    return _courses(8, 16, 2, [(0.72, 0.5, 0.41), (0.68, 0.46, 0.4), (0.76, 0.54, 0.43), (0.7, 0.52, 0.45)],
                    (0.74, 0.71, 0.66), 11)


def stone():
    return _courses(4, 8, 2, [(0.7, 0.66, 0.59), (0.74, 0.7, 0.63), (0.67, 0.64, 0.58)], (0.55, 0.53, 0.5), 23)


def tiles():
    grain = _grain(37, 4)

    def pixel(x, y):
        light = (x * 4 // SIZE + y * 4 // SIZE) % 2
        joint = x % (SIZE // 4) < 2 or y % (SIZE // 4) < 2
        colour = (0.5, 0.48, 0.46) if joint else (0.78, 0.75, 0.7) if light else (0.6, 0.5, 0.44)
        g = 1 + 0.05 * grain(x, y)
        return tuple(c * g for c in colour)

    return png.encode(SIZE, SIZE, pixel)


def cloth():
    def pixel(x, y):
        if y < 24 or y >= SIZE - 24:
            return (0.8, 0.72, 0.5)
        return (0.75, 0.42, 0.42) if (x * 4 // SIZE) % 2 else (0.78, 0.68, 0.55)

    return png.encode(SIZE, SIZE, pixel)
