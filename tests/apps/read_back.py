# Reads what the program has written with other people's readers, h5py and ASE, and compares it, bit for bit, with
# the extended XYZ of the same run, which is read here by splitting its lines. Ends with 77 where they are not there.
import subprocess
import sys

try:
    import ase.io
    import h5py
    import numpy
except ImportError as error:
    print(error)
    sys.exit(77)

program, folder, mode = sys.argv[1:]


def xyz_frames(name):
    """time and an array of id, x, y, vx, vy, radius, mass, one row a ball."""
    lines = open(f"{folder}/{name}").read().splitlines()
    while lines:
        count = int(lines[0])
        time = float(lines[1].split("Time=")[1].split()[0])
        rows = [line.split() for line in lines[2 : count + 2]]
        yield time, numpy.array([[float(row[k]) for k in (0, 2, 3, 5, 6, 8, 9)] for row in rows])
        lines = lines[count + 2 :]


def check_h5md():
    frames = list(xyz_frames("a.xyz"))
    with h5py.File(f"{folder}/a.h5", "r") as file:
        assert list(file["h5md"].attrs["version"]) == [1, 1]
        discs = file["particles/discs"]
        assert list(discs["box"].attrs["boundary"]) == ["periodic", "none"]
        assert discs["box"].attrs["dimension"] == 2
        assert list(discs["box/edges"]) == [24, 24]
        position, velocity = discs["position"], discs["velocity"]
        assert position["value"].compression == "gzip" and position["value"].chunks[0] == 1
        assert list(position["step"]) == list(range(len(frames)))
        assert position["time"] == velocity["time"]  # one data set under two names
        for k, (time, balls) in enumerate(frames):
            assert position["time"][k] == time
            assert (position["value"][k] == balls[:, 1:3]).all()
            assert (velocity["value"][k] == balls[:, 3:5]).all()
        for column, name in ((0, "id"), (5, "radius"), (6, "mass")):
            assert (discs[name][:] == balls[:, column]).all()
        assert list(discs["static"][:]).count(1) == 1
    return len(frames)


def check_dump():
    frames = list(xyz_frames("a.xyz"))
    read = ase.io.read(f"{folder}/a.lammpstrj", index=":", format="lammps-dump-text")
    assert len(read) == len(frames)
    for atoms, (time, balls) in zip(read, frames):
        assert (atoms.positions[:, :2] == balls[:, 1:3]).all()
        # ASE turns LAMMPS' units of time into its own, which are the same factor for all.
        ratio = atoms.get_velocities()[:, :2][balls[:, 3:5] != 0] / balls[:, 3:5][balls[:, 3:5] != 0]
        assert numpy.allclose(ratio, ratio[0], rtol=1e-14)
        assert list(atoms.pbc) == [True, False, True]
    # The velocities' digits, without ASE's factor.
    lines = open(f"{folder}/a.lammpstrj").read().splitlines()
    start = [k for k, line in enumerate(lines) if line.startswith("ITEM: ATOMS")]
    for k, (time, balls) in zip(start, frames):
        rows = [line.split() for line in lines[k + 1 : k + 1 + len(balls)]]
        assert (numpy.array([[float(r[5]), float(r[6])] for r in rows]) == balls[:, 3:5]).all()
    return len(frames)


def check_data():
    """A data file of ASE's, through the program, comes out as it went in."""
    atoms = ase.Atoms("Ar9", cell=[12, 12, 1], pbc=True)
    for k in range(9):
        atoms.positions[k] = (2 + 4 * (k % 3) + 0.1 * k, 2 + 4 * (k // 3), 0)
    ase.io.write(f"{folder}/ase.data", atoms, format="lammps-data", atom_style="atomic")
    open(f"{folder}/data.json", "w").write('{"balls_file": "ase.data", "until": 0}')
    subprocess.run(
        [program, "run", f"{folder}/data.json", "--quiet", "--final", f"{folder}/data.xyz"],
        check=True,
        stdout=subprocess.DEVNULL,
    )
    ((_, balls),) = xyz_frames("data.xyz")
    assert abs(balls[:, 1:3] - atoms.positions[:, :2]).max() < 1e-6  # as many digits as ASE writes
    return len(balls)


print({"h5md": check_h5md, "dump": check_dump, "data": check_data}[mode]())
