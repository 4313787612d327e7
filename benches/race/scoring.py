"""Errors of pictures against a reference, over the pixels of the floor and of the caustic."""
import dataclasses

import numpy as np
import OpenEXR


def channels(path):
    """Channels by name, those that the reader packs into one taken apart."""
    found = {}
    with OpenEXR.File(str(path)) as file:
        for name, channel in file.channels().items():
            if channel.pixels.ndim == 2:
                found[name] = channel.pixels
                continue
            layer = name.removesuffix("RGBA").removesuffix("RGB").removesuffix("XYZ")
            letters = "XYZ" if name.endswith("XYZ") else "RGBA"
            layer = layer + "." if layer and not layer.endswith(".") else layer
            for index in range(channel.pixels.shape[2]):
                found[layer + letters[index]] = channel.pixels[..., index]
    return {name: np.asarray(pixels, np.float64) for name, pixels in found.items()}


def read_rgb(path):
    found = channels(path)
    return np.stack([found[channel] for channel in "RGB"], -1)


@dataclasses.dataclass
class Reference:
    radiance: np.ndarray
    floor: np.ndarray
    caustic: np.ndarray
    # Pixels of the floor without any caustic, by which pictures without units are exposed.
    plain: np.ndarray

    @classmethod
    def of_layers(cls, path):
        """Of a long render with its layers; the floor is the second object. A caustic is what brings a pixel over 5 % of the median direct light."""
        found = channels(path)
        rgb = lambda layer: np.stack([found[f"{layer}.{channel}"] for channel in "RGB"], -1)
        objects = found[next(name for name in found if name.lower().startswith("object"))]
        inside = np.abs(found["albedo.R"] - 0.8) < 1e-3
        floor = (np.round(objects) == 2) & inside
        direct, caustic = rgb("direct").mean(-1), rgb("caustic").mean(-1)
        median = np.median(direct[floor])
        lit = floor & (caustic > 0.05 * median)
        return cls(read_rgb(path), floor, lit, floor & (caustic < 1e-4 * median) & (direct > 0.5 * median))

    @classmethod
    def of_shared(cls, path):
        found = channels(path)
        radiance = np.repeat(found["radiance"][..., None], 3, -1)
        floor, caustic = found["floor_mask"] > 0.5, found["caustic_mask"] > 0.5
        return cls(radiance, floor, caustic, floor & ~caustic)

    def errors(self, picture):
        """The mean of min(1, (i - r)^2 / (r^2 + 0.01 mean(r)^2)) over the caustic's pixels, and over the floor's."""
        return tuple(self._error(picture, mask) for mask in (self.caustic, self.floor))

    def _error(self, picture, mask):
        r = self.radiance[mask]
        return float(np.minimum((picture[mask] - r) ** 2 / (r**2 + 0.01 * r.mean() ** 2), 1).mean())

    def energy(self, picture):
        return float(picture[self.caustic].mean() / self.radiance[self.caustic].mean())

    def exposed(self, picture):
        return picture * (self.radiance[self.plain].mean() / picture[self.plain].mean())
