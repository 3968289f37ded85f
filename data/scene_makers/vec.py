"""Three-vectors as tuples, and the rotations that glTF nodes want."""
import math


def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def scale(a, s):
    return (a[0] * s, a[1] * s, a[2] * s)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def length(a):
    return math.sqrt(dot(a, a))


def normalize(a):
    return scale(a, 1 / length(a))


def rotate(q, v):
    """v turned by the unit quaternion q = (x, y, z, w)."""
    t = scale(cross(q[:3], v), 2)
    return add(add(v, scale(t, q[3])), cross(q[:3], t))


def about_y(angle_rad):
    return (0.0, math.sin(angle_rad / 2), 0.0, math.cos(angle_rad / 2))


def looking_along(direction):
    """Quaternion that turns -Z onto `direction` and keeps +X level: glTF's cameras and lights look along -Z."""
    z = scale(normalize(direction), -1)
    up = (0.0, 1.0, 0.0) if abs(z[1]) < 0.999999 else (0.0, 0.0, -1.0 if z[1] > 0 else 1.0)
    x = normalize(cross(up, z))
    y = cross(z, x)
    m00, m11, m22 = x[0], y[1], z[2]
    squares = [1 + m00 - m11 - m22, 1 - m00 + m11 - m22, 1 - m00 - m11 + m22, 1 + m00 + m11 + m22]
    largest = squares.index(max(squares))
    s = 2 * math.sqrt(squares[largest])
    sums = {(0, 1): x[1] + y[0], (0, 2): x[2] + z[0], (1, 2): y[2] + z[1]}
    differences = (y[2] - z[1], z[0] - x[2], x[1] - y[0])
    q = [0.0] * 4
    for i in range(4):
        if i == largest:
            q[i] = s / 4
        elif largest == 3:
            q[i] = differences[i] / s
        elif i == 3:
            q[i] = differences[largest] / s
        else:
            q[i] = sums[min(i, largest), max(i, largest)] / s
    return tuple(q)
