"""Prints the model that a training or a merge has made."""
from __future__ import annotations

from typing import List, Tuple

from self_awareness import TrainedModel
from self_awareness.stamps import SECOND_NS


def print_summary(model: TrainedModel) -> None:
    """Print how much a model was trained on, and what it knows."""
    types = model.event_types
    seconds = sum(recording.end - recording.start for recording in model.recordings) / SECOND_NS
    sources = {event_type.source for event_type in types} - {''}
    print(f'detector     {model.detectors}')
    print(f'recordings   {len(model.recordings)}')
    print(f'duration     {seconds:.1f} s')
    print(f'events       {model.events}')
    print(f'event types  {len(types)}')
    print(f'sources      {len(sources) if sources else "not told apart"}')
    print(f'pairs        {model.pairs} of {len(types) ** 2} with delays')
    print(f'graph        connections: {len(model.graph) or "none"}')
    rare = _too_rare(model)
    print(f'too rare to judge (fewer than {model.fewest_gaps} gaps between two of a kind)  '
          f'{len(rare)}')
    for name, gaps in rare:
        print(f'  {name}: {gaps} {"gap" if gaps == 1 else "gaps"}')


def _too_rare(model: TrainedModel) -> List[Tuple[str, int]]:
    return [(str(event_type), model.gaps(index))
            for index, event_type in enumerate(model.event_types)
            if model.gaps(index) < model.fewest_gaps and not event_type.is_latched]
