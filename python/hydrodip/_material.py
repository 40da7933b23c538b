"""Film materials of one's own."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Callable, Union

from . import _core

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from ._types import Array


class Material:
    """An isotropic film that resists its deformation by an energy density of your own.

    Parameters
    ----------
    energy : callable or (samples, samples) float64
        A function of two arrays, the principal stretches, that returns the energy density there,
        or its values over a square: energy[i, j] at the i-th and j-th of `samples` even steps from
        `least` to `most`. Only its differences count, and only in proportion: equilibrium knows
        no unit of energy. Exchanging the two must change nothing. Printed film is `modulus` times
        as stiff, as with the paper's material.
    least, most : float
        The range in which the function is sampled; beyond it, it goes on as a parabola.
    samples : int
        Along each side. Between them lies a bicubic spline; its error falls with the fourth power.
    of : "stretch" or "shrink"
        "stretch": of the film's principal stretches, lengths now over lengths printed, per mm^2 of
        flat film, as books have it. "shrink": of their inverses, per mm^2 of film as it floats, as
        the paper's Eq. 3 and the solver have it.

    Raises InputError for energies that are not finite, or depend on the order of the stretches.
    """

    def __init__(
        self,
        energy: Union[Callable[[Array, Array], Any], Array],
        *,
        least: float = 0.4,
        most: float = 2.5,
        samples: int = 129,
        of: str = "stretch",
    ) -> None:
        import numpy as np

        if of not in ("stretch", "shrink"):
            raise _core.InputError(f"of: has to be 'stretch' or 'shrink', not {of!r}")
        if callable(energy):
            if of == "stretch":
                # Sampled where the solver asks.
                least, most = 1 / most, 1 / least
            side = np.linspace(least, most, samples)
            a, b = np.meshgrid(side, side, indexing="ij")
            table = a * b * energy(1 / a, 1 / b) if of == "stretch" else energy(a, b)
            table = np.broadcast_to(np.asarray(table, dtype=np.float64), a.shape)
            self._law = _core.Law.from_table(np.ascontiguousarray(table), least, most)
        elif of == "stretch":
            self._law = _core.Law.from_stretch_table(np.asarray(energy), least, most)
        else:
            self._law = _core.Law.from_table(np.asarray(energy), least, most)

    @classmethod
    def paper(cls, poisson: float = 0.0) -> Material:
        """The built-in material: corotated linear elasticity, Eq. 3 of the paper."""
        made = cls.__new__(cls)
        made._law = _core.Law.paper(poisson)
        return made

    def values_at(self, shrink: Array) -> Array:
        """Energy and its derivatives as the solver has them.

        shrink : (n, 2), principal values a and b: lengths printed over lengths now.
        Returns (n, 6): energy, d/da, d/db, d2/da2, d2/dadb, d2/db2, per mm^2 of floating film.
        """
        return self._law.values_at(shrink)
