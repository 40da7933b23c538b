"""Each line marked `mistake` is one that mypy has to name."""

import hydrodip

hydrodip.simulate("a.obj", film_elemnts=3)  # mistake
hydrodip.simulate("a.obj", film_elements="many")  # mistake
hydrodip.simulate("a.obj", object_down="sideways")  # mistake
hydrodip.design("a.obj").film_picture  # mistake
hydrodip.orient("a.obj").poses[0].score.upper()  # mistake
hydrodip.plot_film(hydrodip.orient("a.obj"))  # mistake
