"""One scene, two methods: pools by moving particles beside the weakly compressible liquid, on accuracy, noise of the
pressure and cost.

pools   four scenes, each by both methods in turn, and water at rest as the ladder of moving particles has it
"""

NAMES = ("pools",)
