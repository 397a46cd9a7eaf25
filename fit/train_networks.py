#!/usr/bin/env python3
"""Trains the networks of `calibrated` on the examples of alcove_fit_examples, with PyTorch (Debian's python3-torch).

    fit/train_networks.py FOLDER OUTPUT [--epochs N] [--only PROBES]

Reads FOLDER/train.bin and test.bin. Writes the coefficients of each network to OUTPUT/calibrated_PROBES.f32, as
little-endian floats in the order that RingNetwork expects, and prints the mean RMSE over the test meshes. Takes a few
minutes on one core.
"""

import argparse
import math
import pathlib
import time

import numpy
import torch

# The number of probes along the normal, of azimuths, and of probes at each azimuth, as in calibrated_probes.h. The
# networks are in the order of their inputs in a row.
NETWORKS = {13: (5, 4, 2), 38: (6, 8, 4), 63: (7, 8, 7)}
# The sizes of the layers: two layers at each azimuth, and one for the whole surfel.
LAYERS = {13: (16, 16, 32), 38: (16, 16, 32), 63: (24, 16, 32)}
RADII = (0.02, 0.05, 0.1, 0.2, 0.5, math.inf)
ROW = numpy.dtype([("inputs", "<u2", sum(NETWORKS)), ("condition", "<f4", 2), ("radius", "<f4"), ("ao", "<f4"),
                   ("scene", "<f4")])


class RingNetwork(torch.nn.Module):
    """See lib/alcove/occlusion/detail/ring_network.h."""

    def __init__(self, probes):
        super().__init__()
        self.normals, self.azimuths, self.features = NETWORKS[probes]
        first, second, hidden = LAYERS[probes]
        whole = self.normals + 2
        self.own = torch.nn.Linear(self.features, first)
        self.neighbours = torch.nn.Linear(self.features, first, bias=False)
        self.shared = torch.nn.Linear(whole, first, bias=False)
        self.second = torch.nn.Linear(first, second)
        self.third = torch.nn.Linear(second + whole, hidden)
        self.last = torch.nn.Linear(hidden, 1, bias=False)

    def hidden(self, inputs, condition):
        ring = inputs[:, self.normals:].reshape(-1, self.azimuths, self.features)
        whole = torch.cat([inputs[:, :self.normals], condition], 1)
        middle = 0.5 * (ring.roll(1, 1) + ring.roll(-1, 1))
        each = torch.relu(self.own(ring) + self.neighbours(middle) + self.shared(whole)[:, None])
        each = torch.relu(self.second(each))
        return torch.relu(self.third(torch.cat([each.mean(1), whole], 1)))

    def forward(self, inputs, condition):
        """The ao before it is clamped: 1 on a plane, where all inputs are 0, whatever the condition."""
        on_plane = self.hidden(torch.zeros_like(inputs), condition)
        return 1.0 + self.last(self.hidden(inputs, condition) - on_plane).squeeze(1)

    def coefficients(self):
        parts = (self.own.weight, self.neighbours.weight, self.shared.weight, self.own.bias, self.second.weight,
                 self.second.bias, self.third.weight, self.third.bias, self.last.weight)
        return torch.cat([part.detach().flatten() for part in parts]).numpy().astype("<f4")


class Examples:
    def __init__(self, path, probes):
        rows = numpy.memmap(path, ROW, "r")
        first = sum(count for count in NETWORKS if count < probes)
        self.inputs = numpy.ascontiguousarray(rows["inputs"][:, first:first + probes])
        self.condition = torch.from_numpy(rows["condition"].copy())
        self.radius, self.scene = rows["radius"].copy(), rows["scene"].copy()
        self.ao = torch.from_numpy(rows["ao"].copy())

    def batch(self, chosen):
        inputs = torch.from_numpy(self.inputs[chosen].astype(numpy.float32)) * (2.5 / 65535.0) - 1.0
        return inputs, self.condition[chosen], self.ao[chosen]


def loss_of(value, ao):
    """Huber's loss of the clamped value (Huber 1964). Beyond the range of ao, where a clamp has no gradient, the error
    still grows a little, unless the clamped value is right."""
    right = (value > 1) & (ao >= 1) | (value < 0) & (ao <= 0)
    clamped = value.clamp(0, 1)
    error = torch.where(right, torch.zeros_like(value), clamped + 0.1 * (value - clamped) - ao)
    return torch.nn.functional.huber_loss(error, torch.zeros_like(error), delta=0.1)


def train(network, examples, epochs, batch=1024, rate=4e-3):
    """Adam (Kingma and Ba 2015) with a warm-up and a cosine schedule."""
    optimizer = torch.optim.Adam(network.parameters(), lr=rate)
    per_epoch = len(examples.ao) // batch
    steps, start = epochs * per_epoch, time.time()
    for step in range(steps):
        if step % per_epoch == 0:
            order = numpy.random.permutation(len(examples.ao))
        share = step / steps
        for group in optimizer.param_groups:
            group["lr"] = max(rate * min(1, (step + 1) / 200) * 0.5 * (1 + math.cos(math.pi * share)), 1e-5)
        chosen = order[step % per_epoch * batch:][:batch]
        inputs, condition, ao = examples.batch(chosen)
        loss = loss_of(network(inputs, condition), ao)
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()
        if step % per_epoch == per_epoch - 1:
            print(f"  epoch {step // per_epoch + 1}: {time.time() - start:.0f} s", flush=True)


def errors(network, examples):
    """The RMSE at each radius, averaged over meshes."""
    with torch.no_grad():
        value = torch.cat([network(*examples.batch(slice(at, at + 8192))[:2]).clamp(0, 1)
                           for at in range(0, len(examples.ao), 8192)])
    square = ((value - examples.ao) ** 2).numpy()
    means = []
    for radius in RADII:
        at_radius = examples.radius == numpy.float32(radius)
        scenes = numpy.unique(examples.scene[at_radius])
        means.append(float(numpy.mean([math.sqrt(square[at_radius & (examples.scene == s)].mean()) for s in scenes])))
    return means


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("--epochs", type=int, default=10)
    parser.add_argument("--only", type=int, choices=NETWORKS)
    options = parser.parse_args()
    for probes in [options.only] if options.only else NETWORKS:
        torch.manual_seed(1)
        numpy.random.seed(1)
        print(f"{probes} probes", flush=True)
        network = RingNetwork(probes)
        train(network, Examples(options.folder / "train.bin", probes), options.epochs)
        network.coefficients().tofile(options.output / f"calibrated_{probes}.f32")
        found = errors(network, Examples(options.folder / "test.bin", probes))
        print("  RMSE " + ", ".join(f"{100 * r:g} %: {e:.4f}" for r, e in zip(RADII, found)), flush=True)


if __name__ == "__main__":
    main()
