"""From simulated bearings to measured ones: what does a model know that has seen no rig?

python3 sim_to_real.py CAMPAIGN [MEASURED]

CAMPAIGN is the folder of fixtures/campaigns/learn6205.ron, MEASURED one with `cwru`, `cwru-more` and `hit-sm` of public records.
Without it the simulated bearings are split among themselves.
"""

import re
import sys
from pathlib import Path

import numpy as np
from sklearn.ensemble import RandomForestClassifier
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler

import stribeck
from stribeck import learn

KINDS = {"IR": "inner", "OR": "outer", "B": "ball", "Normal": "sound"}
NUMBERED = {"97": ("sound", "sound"), "106": ("inner", "IR-007"), "119": ("ball", "B-007"), "131": ("outer", "OR-007-at6"),
            "210": ("inner", "IR-021")}


def cwru(folder):
    """Records of the drive-end 6205 at 12 kHz: samples, rate, speed, class, bearing."""
    from scipy.io import loadmat

    for file in sorted([*folder.glob("cwru/*.mat"), *folder.glob("cwru-more/DE-*.mat")]):
        number = re.match(r"\d+", file.stem)
        if number:
            kind, bearing = NUMBERED[number[0]]
        else:
            parts = file.stem.split("-")
            kind, bearing = KINDS[parts[1]], "-".join(parts[1:-1])
        content = loadmat(file)
        signal = next(content[name] for name in content if name.endswith("DE_time")).ravel()
        speeds = [content[name].item() for name in content if name.endswith("RPM")]
        # The healthy record is sampled at 48 kHz.
        rate = 48_000 if kind == "sound" else 12_000
        yield signal, rate, speeds[0] if speeds else (1750 if file.stem.endswith("2") else 1797), kind, f"CWRU {bearing}"


def hit(folder):
    """Records of the 6205 of HIT-SM at 51.2 kHz."""
    from scipy.io import loadmat

    for file in sorted(folder.glob("hit-sm/*.mat")):
        kind, size, rpm = re.match(r"([A-Za-z]+)(\d*)_(\d+)", file.stem).groups()
        content = loadmat(file)
        signal = next(np.ravel(value) for name, value in content.items() if not name.startswith("__"))
        yield signal, 51_200, float(rpm), KINDS[kind], f"HIT {kind}{size}"


def model():
    forest = RandomForestClassifier(400, min_samples_leaf=2, class_weight="balanced", random_state=1)
    return make_pipeline(StandardScaler(), forest)


def score(name, train, test):
    """Trains on one rig and tries on another; classes that the test does not have are none of the answers."""
    fitted = model().fit(train.features, train.labels)
    shares = fitted.predict_proba(test.features)
    there = np.isin(fitted.classes_, np.unique(test.labels))
    said = fitted.classes_[there][np.argmax(shares[:, there], axis=1)]
    told(name, test.labels, said, test.bearings)


def told(name, truth, said, bearings):
    low, high = learn.interval(truth, said, bearings)
    print(f"{name:<44} {learn.macro_f1(truth, said):.2f}  [{low:.2f}, {high:.2f}]  {len(truth)} windows, {len(set(bearings))} bearings")


def verdict(name, records):
    """What `analyse` says of each whole record, without learning: the first claim is the class."""
    classes = {"BPFO": "outer", "BPFI": "inner", "BSF": "ball"}
    truth, said, bearings = [], [], []
    for signal, rate, speed, kind, bearing in records:
        families = stribeck.analyse(signal, rate, bearing="6205", speed_rpm=speed)["families"]
        claims = [classes.get(family["name"]) for family in families if family["claimed"]]
        answer = next((claim for claim in claims if claim), "sound")
        truth.append(learn.CLASSES.index(kind))
        said.append(learn.CLASSES.index(answer))
        bearings.append(bearing)
    told(name, np.array(truth), np.array(said), np.array(bearings))


def main():
    simulated = learn.from_campaign(sys.argv[1], bearing="6205")
    print(simulated)
    for train, test in learn.by_bearing(simulated.bearings, simulated.labels):
        fitted = model().fit(simulated.features[train], simulated.labels[train])
        said = fitted.predict(simulated.features[test])
        told("simulated, split by bearing", simulated.labels[test], said, simulated.bearings[test])
    if len(sys.argv) < 3:
        return
    folder = Path(sys.argv[2])
    rigs = {"CWRU": list(cwru(folder)), "HIT": list(hit(folder))}
    windows = {name: learn.Windows.of(records, bearing="6205", most=6) for name, records in rigs.items()}
    for name, other in (("CWRU", "HIT"), ("HIT", "CWRU")):
        test = windows[name]
        score(f"simulated alone → {name}", simulated, test)
        # The background is a healthy bearing of the other rig, so that nothing of this one is known.
        sound = next(record for record in rigs[other] if record[3] == "sound")
        mixed = sum((simulated.with_background(sound[0], sound[1], ratio) for ratio in (1.0, 3.0)), simulated)
        score(f"simulated with background of {other} → {name}", mixed, test)
        score(f"{other} → {name}", windows[other], test)
        score(f"{other} and simulated with background → {name}", windows[other] + mixed, test)
        verdict(f"verdict of analyse, no learning, {name}", rigs[name])


if __name__ == "__main__":
    main()
